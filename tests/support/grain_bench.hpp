#pragma once
// A few grains and walls, set up in code and run through SolidSolver.

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "bedload/case/config.hpp"
#include "bedload/geometry/shape.hpp"
#include "src/solids/solid_solver.hpp"
#include "tests/support/tolerance.hpp"
#include "tests/support/walls.hpp"

namespace BL_SOLVER {

class GrainBench {
 public:
  static constexpr int kChunk = 20;  // substeps between looks at the lists

  Config config;
  std::vector<Vec3d> x, v, omega;  ///< initial; m, m/s, rad/s
  std::vector<double> radius;      ///< m
  std::unique_ptr<GrainStore> grains;
  std::unique_ptr<WallGeometry> walls;
  std::unique_ptr<SolidSolver> solver;
  std::unique_ptr<CellGrid> grid;
  std::function<BodyPose(int body, double time)> motion = [](int, double) { return BodyPose{}; };
  double wall_speed = WallList::kAnywhere;  ///< of no wall more, m/s; without it all surfaces are listed
  double time = 0;
  int refreshes = 0;

  /// Glass-like grains of 2.7 mm without gravity, rolling friction or walls.
  GrainBench() {
    config.domain.min = {-0.1, -0.1, -0.1};
    config.domain.max = {0.1, 0.1, 0.1};
    config.gravity = {};
    config.grain.present = true;
    config.grain.d = 2.7e-3;
    config.contact.rolling = "none";
  }
  void plane(const Vec3d& point, const Vec3d& normal) {
    WallBody body;
    body.shape = "plane";
    body.point = point;
    body.normal = normal;
    config.wall.bodies.push_back(body);
  }
  void add(const Vec3d& at, const Vec3d& velocity = {}, const Vec3d& spin = {}, double r = 0) {
    x.push_back(at), v.push_back(velocity), omega.push_back(spin);
    radius.push_back(r > 0 ? r : 0.5 * config.grain.d);
  }
  double R() const { return 0.5 * config.grain.d; }
  double mass(double r) const { return 4.0 / 3.0 * M_PI * r * r * r * config.grain.rho; }
  double mass() const { return mass(R()); }
  double E_star() const { return config.grain.E / (2 * (1 - config.grain.nu * config.grain.nu)); }
  /// Overlap of a grain resting on a Hertzian plane under the force f (N).
  double resting_overlap(double f) const {
    return std::pow(f / (4.0 / 3.0 * E_star() * std::sqrt(R())), 2.0 / 3.0);
  }
  /// Contact time of two grains (walls: of one) without damping, s.
  double contact_time(double speed, bool with_wall = false) const {
    const double m = with_wall ? mass() : mass() / 2, r = with_wall ? R() : R() / 2;
    return 2.8683 * std::pow(m * m / (r * E_star() * E_star() * speed), 0.2);
  }

  /// Everything up to the store; `store` fields may then be changed before start().
  void build() {
    for (double r : radius) {
      config.grain.d_max = std::max(config.grain.d_max, 2 * r);
      config.grain.d_min = config.grain.d_min > 0 ? std::min(config.grain.d_min, 2 * r) : 2 * r;
    }
    const auto& p = config.domain.periodic;
    frame_ = Frame(config.domain.min, config.domain.max, p[0], p[1], p[2]);
    grains = std::make_unique<GrainStore>();
    walls = std::make_unique<WallGeometry>(config.wall.bodies, config.domain);
    solver = std::make_unique<SolidSolver>(solid_parameters(config), frame_, *walls, *grains);
    grid = std::make_unique<CellGrid>(frame_, config.domain.min, config.domain.max, solver->range());
    grains->resize(Index(x.size()));
    std::vector<Id> id(x.size());
    std::vector<Real> r(radius.begin(), radius.end());
    std::vector<Real3> vr, wr;
    for (Id i = 0; i < x.size(); ++i) {
      id[i] = i;
      vr.push_back(Real3(v[i]));
      wr.push_back(Real3(omega[i]));
    }
    grains->id.assign(id);
    grains->x.assign(x), grains->x_list.assign(x);
    grains->radius.assign(r), grains->v.assign(vr), grains->omega.assign(wr);
  }
  void start() {
    build();
    refresh();
    set_poses(1, 0);
    solver->evaluate(*grains, poses());
  }
  void refresh() {
    solver->refresh(*grains, *grid);
    ++refreshes;
  }
  /// `steps` substeps of dt; lists follow the grains.
  void run(double dt, int steps, bool held = false) {
    for (int done = 0; done < steps;) {
      const int n = std::min(kChunk, steps - done);
      set_poses(n, dt);
      solver->advance(*grains, poses(), int(config.wall.bodies.size()), n * dt, n, held, {},
                      n * dt * wall_speed);
      time += n * dt;
      done += n;
      if (grains->size() > 1 && solver->watch(*grains).displacement > 0.4 * solver->skin()) refresh();
    }
  }
  Span<const BodyPose> poses() const { return {poses_.data(), Index(config.wall.bodies.size())}; }
  /// Poses at `time` and after each of the next n substeps.
  void set_poses(int n, double dt) {
    std::vector<BodyPose> all;
    for (int s = 0; s <= n; ++s)
      for (int b = 0; b < int(config.wall.bodies.size()); ++b) all.push_back(motion(b, time + s * dt));
    poses_.assign(all);
  }

  // State by id.
  template <class T>
  T of(const Field<T>& field, Id id) const {
    const auto ids = grains->id.values();
    const auto values = field.values();
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] == id) return values[i];
    ADD_FAILURE() << "no grain " << id;
    return {};
  }
  Vec3d position(Id id = 0) const { return of(grains->x, id); }
  Vec3d velocity(Id id = 0) const { return Vec3d(of(grains->v, id)); }
  Vec3d spin(Id id = 0) const { return Vec3d(of(grains->omega, id)); }
  Vec3d force(Id id = 0) const { return Vec3d(of(grains->force, id)); }
  Vec3d torque(Id id = 0) const { return Vec3d(of(grains->torque, id)); }

 private:
  Frame frame_;
  Buffer<BodyPose> poses_;
};

}  // namespace BL_SOLVER
