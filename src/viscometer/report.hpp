#pragma once
// Report of a viscometer: lines for the terminal, tables and a picture.

#include <filesystem>
#include <string>

#include "src/viscometer/viscosity.hpp"

namespace bedload {

/// Lines for the terminal; mu: of the case, Pa s.
std::string report_text(const ViscosityResult& result, const PlaneFlow& flow, double mu);

/// Creates the folder and writes result.csv with `quantities`, profile.csv, stress.csv and profile.png.
/// Throws FileError.
void write_report(const std::filesystem::path& folder, const ViscosityResult& result, const PlaneFlow& flow,
                  const std::vector<Quantity>& quantities, const std::string& title);

}  // namespace bedload
