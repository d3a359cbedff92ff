#pragma once
#include "options.hpp"

namespace bedload {

inline constexpr int kExitBadInput = 2, kExitFault = 3, kExitLost = 4, kExitNoViscosity = 5,
                     kExitStopped = 130;

/// The program: runs the command that the arguments name. Errors are printed, a sentence each; returns the
/// exit code.
int run_program(int argc, const char* const* argv);

/// Runs a case; returns the exit code: 0, 4 if more than run.max_lost has left the domain, 130 if stopped by
/// a signal.
int run_case(const Options& options);
/// Prints particles, step limits, memory, run time and warnings of a case.
int check_case(const Options& options);
/// Writes a template to a file, or lists them. Throws FileError if the file exists.
int new_case(const Options& options);
/// Runs a template and draws it; returns the exit code of the run.
int demo(const Options& options);
/// Runs a plane shear flow and reports its viscosity; returns the exit code of the run, or 5 if the fit of
/// the profile is rejected. Throws KeyError if the case is no plane shear flow.
int viscometer(const Options& options);
/// Prints the contents of a checkpoint, a .vtkhdf file or a summary.json. Throws FileError.
int show_file(const std::filesystem::path& file);
/// Becomes the window of the Python package, in the browser. Throws FileError if there is no Python.
int open_window(const Options& options);
/// Makes a case from one of another program, or writes the frames of a run in another format; prints what it
/// wrote, and to stderr what has no counterpart. Throws CaseError, FileError.
int convert(const Options& options);
/// Measures the drag of arrays of fixed grains that a fluid on a lattice flows around, prints it and writes it
/// as a table for drag.law = "table". Throws FileError if the file exists.
int drag(const Options& options);
/// Times steps of built-in or user cases and prints a table. Bad input is reported before anything is timed;
/// after a later error the results so far are printed.
int bench(const Options& options);

}  // namespace bedload
