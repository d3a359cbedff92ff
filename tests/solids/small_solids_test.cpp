// Every kernel of the solid solver once, in little time: what sanitizers run.
#include "tests/support/grain_bench.hpp"

namespace BL_SOLVER {
namespace {

TEST(SmallSolids, EveryKernelRuns) {
  for (const char* rolling : {"epsd", "cdt", "none"})
    for (const char* tangential : {"mindlin", "mindlin_deresiewicz", "linear", "none"}) {
      GrainBench b;
      b.config.gravity = {0, 0, -9.81};
      b.config.domain.periodic = {true, false, false};
      b.config.contact.rolling = rolling;
      b.config.contact.tangential = tangential;
      WallBody tank;
      tank.shape = "tank";
      tank.min = {-0.1, -0.01, 0}, tank.max = {0.1, 0.01, 0.05};
      WallBody gate;
      gate.shape = "box";
      gate.min = {-0.0455, -0.01, 0}, gate.max = {-0.0435, 0.01, 0.05};
      b.config.wall.bodies = {tank, gate};
      b.plane({0, 0, 0}, {0, 0, 1});
      for (int i = 0; i < 40; ++i)
        b.add({-0.0981 + 2.69e-3 * (i % 20), 0, 1.34e-3 + 2.69e-3 * (i / 20)}, {0.1, 0, -0.1});
      b.start();
      b.grains->drag_coefficient.assign(std::vector<Real>(40, Real(1e-3)));
      b.grains->rot_drag_coefficient.assign(std::vector<Real>(40, Real(1e-9)));
      b.run(2e-6, 25);
      b.refresh();
      b.run(5e-6, 5, true);
      b.set_poses(1, 0);
      EXPECT_EQ(b.solver->watch(*b.grains).bad, kNone);
      EXPECT_GT(b.solver->totals(*b.grains).contacts, 10);
      EXPECT_GT(b.solver->totals(*b.grains).wall_contacts, 10);
      EXPECT_LT(b.solver->body_loads(*b.grains, b.poses())[0].force().z, 0);
      const HostStore contacts = b.solver->save_contacts(*b.grains);
      b.solver->load_contacts(*b.grains, *b.grid, contacts);
      EXPECT_EQ(b.solver->save_contacts(*b.grains).arrays[2].bytes, contacts.arrays[2].bytes);
    }
}

}  // namespace
}  // namespace BL_SOLVER
