#pragma once
// The chapters of describe().

#include "bedload/case/config.hpp"
#include "bedload/case/parameters.hpp"

namespace bedload {

/// Whether keys of fluid made of particles are wanted.
inline bool of_particles(const Parameters& p, const FluidConfig& fluid) {
  return !fluid.lattice() || p.everything();
}

void describe_top(Parameters& p, Config& config);
void describe_domain(Parameters& p, Config& config);
void describe_shapes(Parameters& p, std::vector<ShapeConfig>& shapes);
void describe_frame(Parameters& p, FrameConfig& frame);
/// Where a fill takes its particles from.
void describe_fill_file(Parameters& p, std::string& file, std::int64_t& step, std::string_view meaning);
void describe_fluid(Parameters& p, FluidConfig& fluid);
void describe_fluid_models(Parameters& p, Config& config);
void describe_lattice(Parameters& p, LatticeConfig& lattice);
void describe_drive(Parameters& p, Config& config);
/// Contacts are already described.
void describe_walls(Parameters& p, Config& config);
/// Of one wall body; grain.* stands in for its material when the case is resolved.
void describe_free_body(Parameters& p, FreeConfig& free);
void describe_rigid_group(Parameters& p, RigidConfig& rigid);
void describe_clump(Parameters& p, ClumpConfig& clump);
/// What of a fill or an inlet are clumps.
void describe_clumps_of(Parameters& p, std::string& clump, std::vector<double>& orientation);
void describe_inlets(Parameters& p, std::vector<InletConfig>& inlets);
void describe_outlets(Parameters& p, std::vector<OutletConfig>& outlets);
void describe_grain_inlets(Parameters& p, std::vector<GrainInletConfig>& inlets);
void describe_grain_material(Parameters& p, std::string& material);
void describe_grain_size(Parameters& p, SizeClass& size);
void describe_contact(Parameters& p, ContactConfig& contact);
void describe_lubrication(Parameters& p, LubricationConfig& lubrication);
void describe_grains(Parameters& p, Config& config);
void describe_coupling(Parameters& p, CouplingConfig& coupling);
void describe_time(Parameters& p, Config& config);
void describe_output(Parameters& p, OutputConfig& output);
void describe_paper(Parameters& p, Config& config);

}  // namespace bedload
