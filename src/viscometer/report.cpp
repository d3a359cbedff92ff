#include "src/viscometer/report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "bedload/output/files.hpp"
#include "src/viewer/plot.hpp"

namespace bedload {
namespace {

constexpr const char* kAxes = "xyz";

/// Empty for NaN.
std::string cell(double value) { return std::isfinite(value) ? fmt::format("{:.9g}", value) : ""; }

std::string profile_table(const ViscosityResult& r, const PlaneFlow& flow) {
  std::string out = fmt::format(
      "{} [m],velocity [m/s],fit [m/s],grain_velocity [m/s],shear_stress [Pa],imposed_stress [Pa],filled "
      "[-]\n",
      kAxes[flow.gradient]);
  for (const ProfileRow& row : r.profile)
    out += fmt::format("{},{},{},{},{},{},{:.4g}\n", cell(row.z), cell(row.velocity), cell(row.fit),
                       cell(row.grain_velocity), cell(row.shear_stress), cell(row.imposed), row.filled);
  return out;
}

/// The quantities of summary.json as a table of one row.
std::string result_table(const std::vector<Quantity>& quantities) {
  std::string head, row;
  for (const Quantity& q : quantities) {
    const char* const separator = head.empty() ? "" : ",";
    head += fmt::format("{}{} [{}]", separator, q.name, q.unit);
    row += fmt::format("{}{:.9g}", separator, q.value);
  }
  return head + '\n' + row + '\n';
}

std::string stress_table(const ViscosityResult& r) {
  std::string out = "part";
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) out += fmt::format(",stress_{}{} [Pa]", kAxes[i], kAxes[j]);
  out += '\n';
  for (const StressPart& part : r.stress) {
    out += part.name;
    for (const double value : part.mean) out += fmt::format(",{:.9g}", value);
    out += '\n';
  }
  return out;
}

Image picture(const ViscosityResult& r, const PlaneFlow& flow, const std::string& title) {
  const Colour measured{0.2f, 0.45f, 0.85f}, expected{0.85f, 0.3f, 0.15f}, grains{0.75f, 0.5f, 0.15f};
  Curve fluid{"fluid", {}, {}, measured}, fit{"fit", {}, {}, expected, true}, solid{"grains", {}, {}, grains};
  Curve shear{"measured", {}, {}, measured}, imposed{"imposed", {}, {}, expected, true};
  for (const ProfileRow& row : r.profile) {
    for (Curve* c : {&fluid, &fit, &solid, &shear, &imposed}) c->x.push_back(row.z);
    fluid.y.push_back(row.velocity), fit.y.push_back(row.fit), solid.y.push_back(row.grain_velocity);
    shear.y.push_back(row.shear_stress), imposed.y.push_back(row.imposed);
  }
  Plot velocity{title,
                fmt::format("{} [m]", kAxes[flow.gradient]),
                fmt::format("velocity along {} [m/s]", kAxes[flow.along]),
                {fluid, fit}};
  if (r.concentration > 0) velocity.curves.push_back(solid);
  const Plot stress{flow.name() + " flow", velocity.x_name, "shear stress [Pa]", {shear, imposed}};
  return draw({velocity, stress});
}

}  // namespace

std::string report_text(const ViscosityResult& r, const PlaneFlow& flow, double mu) {
  const bool images = flow.kind == PlaneFlowKind::lees_edwards;
  std::string out = fmt::format("flow       {} along {}, gradient along {}, {} = {:.6g} {}\n", flow.name(),
                                kAxes[flow.along], kAxes[flow.gradient],
                                images           ? "shear stress"
                                : flow.sheared() ? "shear stress on the walls"
                                                 : "force",
                                r.imposed, flow.sheared() ? "Pa" : "N/m3");
  out +=
      fmt::format("measured   {} samples in {} blocks; peak {:.4g} m/s, Re {:.3g}, Ma {:.3g}, R^2 {:.4f}\n",
                  r.samples, r.blocks, r.peak, r.reynolds, r.mach, r.r_squared);
  if (flow.walled())
    out += fmt::format("walls      slip length {:.3g} m, profile off centre by {:.3g} m\n", r.slip_length,
                       r.offset);
  if (r.concentration > 0) out += fmt::format("grains     {:.3g} % of the volume\n", 100 * r.concentration);
  out += fmt::format(
      "steady     {}: viscosity of the second half differs by {:+.2g} % from the first, {:.2g} % allowed\n",
      r.stationary() ? "yes" : "NO", 100 * r.drift, 100 * r.drift_limit);
  out += "stress     ";
  if (!images)
    out += fmt::format("shear {:.4g} +- {:.2g} of the imposed; ", r.stress_ratio.mean, r.stress_ratio.error);
  out += fmt::format("N1 {:.3g} +- {:.2g} Pa, N2 {:.3g} +- {:.2g} Pa; pressure {:.4g} Pa\n", r.normal_1.mean,
                     r.normal_1.error, r.normal_2.mean, r.normal_2.error, r.pressure);
  if (r.accepted())
    out += fmt::format("viscosity  {:.6g} +- {:.2g} Pa s, {:.4f} times fluid.mu\n", r.viscosity.mean,
                       r.viscosity.error, r.viscosity.mean / mu);
  return out;
}

void write_report(const std::filesystem::path& folder, const ViscosityResult& result, const PlaneFlow& flow,
                  const std::vector<Quantity>& quantities, const std::string& title) {
  std::filesystem::create_directories(folder);
  write_file(folder / "profile.csv", profile_table(result, flow));
  write_file(folder / "result.csv", result_table(quantities));
  write_file(folder / "stress.csv", stress_table(result));
  picture(result, flow, title).write_png(folder / "profile.png");
}

}  // namespace bedload
