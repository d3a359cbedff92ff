#pragma once
#include "options.hpp"

namespace bedload {

inline constexpr int kExitBadInput = 2, kExitFault = 3, kExitLost = 4, kExitNoViscosity = 5,
                     kExitStopped = 130;

/// The program: runs the command that the arguments name. Errors are printed, a sentence each; returns the
/// exit code.
int run_program(int argc, const char* const* argv);

/// Runs a case to its end; returns the exit code: 0, 4 if more than run.max_lost has left the domain, 130 if
/// stopped by a signal.
int run_case(const Options& options);
/// Prints what a run of the case would be: particles, step limits, memory, run time, warnings.
int check_case(const Options& options);
/// Runs a plane shear flow and tells its viscosity; returns the exit code of the run, or 5 if the profile is
/// not that of a viscous fluid. Throws KeyError where the case is no such flow.
int viscometer(const Options& options);
/// Prints what a checkpoint, a .vtkhdf file or a summary.json holds. Throws FileError.
int show_file(const std::filesystem::path& file);
/// Times whole steps of cases, built in or from files, and prints a table. Bad input is told before anything
/// is timed; after an error later on, what was timed before is printed.
int bench(const Options& options);

}  // namespace bedload
