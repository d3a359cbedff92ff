#include "src/viscometer/viscosity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace bedload {
namespace {

Measured mean_of(const std::vector<double>& values) {
  const double n = double(values.size());
  double sum = 0, squares = 0;
  for (const double v : values) sum += v;
  for (const double v : values) squares += (v - sum / n) * (v - sum / n);
  return {sum / n, std::sqrt(squares / (n * std::max(n - 1, 1.0)))};
}

/// u = a + b s + c s^2, m/s; s = distance from the lower end / gap.
struct Fit {
  double a = 0, b = 0, c = 0;
  double at(double s, double s2) const { return a + b * s + c * s2; }
  /// The viscosity is the imposed force or stress over this, in m/s. With images the shear is imposed, too.
  double strength(const PlaneFlow& flow) const {
    if (flow.kind == PlaneFlowKind::lees_edwards) return flow.relative_speed;
    return flow.sheared() ? b : -2 * c;
  }
};

/// Least squares: reverse Poiseuille A s (1 - s), Couette and Lees-Edwards a line, Poiseuille a parabola.
Fit fit_of(PlaneFlowKind kind, const std::array<double, 5>& s, const std::array<double, 3>& u) {
  switch (kind) {
    case PlaneFlowKind::reverse_poiseuille: {
      const double A = (u[1] - u[2]) / (s[2] - 2 * s[3] + s[4]);
      return {0, A, -A};
    }
    case PlaneFlowKind::couette:
    case PlaneFlowKind::lees_edwards: {
      const double b = (s[0] * u[1] - s[1] * u[0]) / (s[0] * s[2] - s[1] * s[1]);
      return {(u[0] - b * s[1]) / s[0], b, 0};
    }
    case PlaneFlowKind::poiseuille:
      break;
  }
  const double d = s[0] * (s[2] * s[4] - s[3] * s[3]) - s[1] * (s[1] * s[4] - s[3] * s[2]) +
                   s[2] * (s[1] * s[3] - s[2] * s[2]);
  const auto with = [&](int column) {  // Cramer's rule
    double m[3][3] = {{s[0], s[1], s[2]}, {s[1], s[2], s[3]}, {s[2], s[3], s[4]}};
    for (int k = 0; k < 3; ++k) m[k][column] = u[k];
    return (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
            m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
            m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])) /
           d;
  };
  return {with(0), with(1), with(2)};
}

class Evaluation {
 public:
  Evaluation(const Layers& layers, const Config& config, double reach)
      : blocks_(layers.blocks()), c_(config), flow_(layers.flow()), reach_(reach), n_(layers.count()) {
    gather_sparse();
    all_.layers.resize(n_);
    for (const Block& block : blocks_) {
      for (int l = 0; l < n_; ++l) all_.layers[l].add(block.layers[l]);
      for (int k = 0; k < 5; ++k) all_.s[k] += block.s[k];
      for (int k = 0; k < 3; ++k) all_.u[k] += block.u[k];
      all_.stress += block.stress, all_.samples += block.samples;
    }
    double volume = 0;
    for (const LayerSums& layer : all_.layers) volume += layer.volume / all_.samples;
    stretch_ = flow_.area * (flow_.high - flow_.low) / volume;
    const double margin = flow_.gap() > 2.5 * reach ? reach : layers.h();
    for (int l = 0; l < n_; ++l)
      if (!flow_.walled() || layers.inside(l, margin)) averaged_.push_back(l);
    for (int l = 0; l < n_; ++l)
      if (layers.inside(l, layers.h())) inner_.push_back(l);
  }

  ViscosityResult result() {
    ViscosityResult r;
    r.blocks = int(blocks_.size()), r.samples = all_.samples;
    r.imposed = imposed(all_);
    fit_ = fit_of(flow_.kind, all_.s, all_.u);
    const double gap = flow_.gap(), strength = fit_.strength(flow_);
    const bool sheared = flow_.sheared();
    r.viscosity.mean = r.imposed * (sheared ? gap : gap * gap) / strength;

    std::vector<double> deviation;  // of each block, relative
    for (const Block& block : blocks_)
      deviation.push_back(imposed(block) / r.imposed -
                          fit_of(flow_.kind, block.s, block.u).strength(flow_) / strength);
    r.viscosity.error = std::abs(r.viscosity.mean) * mean_of(deviation).error;
    const auto half = deviation.begin() + std::ptrdiff_t(deviation.size() / 2);
    const Measured first = mean_of({deviation.begin(), half}), second = mean_of({half, deviation.end()});
    r.drift = second.mean - first.mean;
    r.drift_limit = std::max(0.01, 3 * std::hypot(first.error, second.error));

    r.r_squared = r_squared();
    if (sheared) r.peak = std::abs(flow_.relative_speed);
    double speed = 0, mass = 0;  // mean over the flow in one direction
    for (const LayerSums& layer : all_.layers) {
      if (layer.fluid.mass == 0) continue;  // fluid on a lattice leaves layers empty
      const double v = std::abs(velocity(layer.fluid));
      if (!sheared) r.peak = std::max(r.peak, v);
      speed += v * layer.fluid.mass, mass += layer.fluid.mass;
    }
    speed = sheared ? r.peak : speed / mass;
    r.reynolds = c_.fluid.rho0 * speed * gap / r.viscosity.mean;
    // with images, neighbours differ by the shear over a kernel radius at most, however high the box, but on
    // a lattice the speed counts; between two moving walls the faster one, as for fluid.vmax
    const bool images = flow_.kind == PlaneFlowKind::lees_edwards;
    const double fastest = images && c_.fluid.lattice()           ? r.peak / 2
                           : images                               ? r.peak * reach_ / gap
                           : flow_.kind == PlaneFlowKind::couette ? flow_.fastest
                                                                  : r.peak;
    r.mach = fastest / c_.fluid.c;
    if (flow_.walled()) walls(r);
    stresses(r);
    for (int l = 0; l < n_; ++l)
      if (all_.layers[l].fluid.mass > 0) r.profile.push_back(row(l, r.imposed));
    double grains = 0;
    for (const LayerSums& layer : all_.layers) grains += layer.grain_volume / all_.samples;
    r.concentration = grains / (flow_.area * (flow_.high - flow_.low));
    return r;
  }

 private:
  /// Fluid without noise keeps its lattice, which leaves layers empty, and hardly any comes close to a wall.
  /// Layers with too little fluid are merged with the nearest one with enough: divided by their own tiny
  /// volume, the contacts of a single grain would give any stress.
  void gather_sparse() {
    std::vector<double> volume(n_);
    for (const Block& block : blocks_)
      for (int l = 0; l < n_; ++l) volume[l] += block.layers[l].volume;
    const double mean = std::accumulate(volume.begin(), volume.end(), 0.0) / n_;
    std::vector<int> wet;
    for (int l = 0; l < n_; ++l)
      if (volume[l] > 0 && volume[l] >= ViscosityResult::kLeastFilled * mean) wet.push_back(l);
    if (wet.empty()) return;
    for (int l = 0; l < n_; ++l) {
      const auto nearer = [&](int a, int b) {
        const auto distance = [&](int k) { return (turned(k) == turned(l) ? 0 : n_) + std::abs(k - l); };
        return distance(a) < distance(b);
      };
      const int home = *std::min_element(wet.begin(), wet.end(), nearer);
      if (home == l) continue;
      for (Block& block : blocks_) {
        block.layers[home].add(block.layers[l]);
        block.layers[l] = {};
      }
    }
  }
  double velocity(const MotionSums& m) const {
    return m.mass > 0 ? m.momentum[flow_.along] / m.mass : std::nan("");
  }
  /// Whether a layer flows against the force of the lower half.
  bool turned(int l) const { return flow_.reversed() && 2 * l >= n_; }
  double sign(int l) const { return turned(l) ? -1 : 1; }

  double imposed(const Block& block) const {
    if (flow_.kind == PlaneFlowKind::couette) return block.stress / block.samples;
    if (flow_.kind == PlaneFlowKind::lees_edwards) return shear_stress(block.layers);
    double force = 0;
    for (int l = 0; l < n_; ++l) force += sign(l) * block.layers[l].drive / block.samples;
    return force / (flow_.area * (flow_.high - flow_.low));
  }

  double shear_stress(const std::vector<LayerSums>& layers) const {
    return component(stress_in(layers, averaged_).back().mean, flow_.along, flow_.gradient);
  }

  double r_squared() const {
    double rest = 0, all = 0, mean = 0, mass = 0;
    const int folds = flow_.reversed() ? 2 : 1, rows = n_ / folds;
    std::vector<std::array<double, 3>> points;  // mass, velocity, fit
    for (int l = 0; l < rows; ++l) {
      double m = 0, momentum = 0, s = 0, s2 = 0;
      for (int k = l; k < n_; k += rows) {
        const LayerSums& layer = all_.layers[k];
        m += layer.fluid.mass, momentum += sign(k) * layer.fluid.momentum[flow_.along];
        s += layer.place, s2 += layer.place2;
      }
      if (m == 0) continue;
      points.push_back({m, momentum / m, fit_.at(s / m, s2 / m)});
      mean += momentum, mass += m;
    }
    for (const auto& [m, v, fit] : points)
      rest += m * (v - fit) * (v - fit), all += m * (v - mean / mass) * (v - mean / mass);
    return 1 - rest / all;
  }

  /// Positions at which the fit has the wall velocities.
  void walls(ViscosityResult& r) const {
    const double gap = flow_.gap();
    if (flow_.kind == PlaneFlowKind::couette) {
      const double low = fit_.a - lower_speed(),
                   high = fit_.a + fit_.b - lower_speed() - flow_.relative_speed;
      r.slip_length = 0.5 * gap * (low - high) / fit_.b;
      r.offset = -0.5 * gap * (low + high) / fit_.b;
      return;
    }
    const double root = std::sqrt(std::max(fit_.b * fit_.b - 4 * fit_.a * fit_.c, 0.0));
    r.slip_length = 0.5 * gap * (root / std::abs(fit_.c) - 1);
    r.offset = gap * (-fit_.b / (2 * fit_.c) - 0.5);
  }
  double lower_speed() const {
    const WallBody& body = c_.wall.bodies[flow_.lower];
    return body.surface_velocity[flow_.along] + (body.motion.moves() ? body.motion.velocity[flow_.along] : 0);
  }

  /// Parts of the stress in some layers, Pa, the total last. The total excludes the noise: it is drawn after
  /// the positions are known, so its virial is zero on average, but its scatter would hide everything else.
  std::vector<StressPart> stress_in(const std::vector<LayerSums>& layers,
                                    const std::vector<int>& which) const {
    LayerSums sum;
    Tensor kinetic{};
    for (const int l : which) {
      sum.add(layers[l]);
      for (const MotionSums* m : {&layers[l].fluid, &layers[l].grains}) {
        const Tensor own = m->fluctuation();
        for (int k = 0; k < 9; ++k) kinetic[k] += own[k];
      }
    }
    std::vector<StressPart> out;
    Tensor& moving = sum.parts["kinetic"];  // of a lattice also that within rows of nodes
    for (int k = 0; k < 9; ++k) moving[k] += kinetic[k];
    StressPart total{"total", {}};
    for (const auto& [name, tensor] : sum.parts) {
      out.push_back({name, tensor});
      for (double& x : out.back().mean) x = sum.volume > 0 ? -x / (stretch_ * sum.volume) : 0;
      if (name == "noise") continue;
      for (int k = 0; k < 9; ++k) total.mean[k] += out.back().mean[k];
    }
    out.push_back(total);
    return out;
  }
  double component(const Tensor& t, int i, int j) const { return t[3 * i + j]; }

  /// Imposed shear stress in a layer, Pa.
  double imposed_at(int l, double imposed) const {
    if (flow_.sheared()) return imposed;
    const LayerSums& layer = all_.layers[l];
    const double s = layer.place / layer.fluid.mass;
    return sign(l) * imposed * flow_.gap() * (0.5 - s);
  }
  double shear_in(const std::vector<LayerSums>& layers, int l) const {
    return component(stress_in(layers, {l}).back().mean, flow_.along, flow_.gradient);
  }
  double stress_ratio(const std::vector<LayerSums>& layers, double imposed) const {
    double top = 0, bottom = 0;
    for (const int l : inner_) {
      const double weight = layers[l].volume;
      if (weight == 0) continue;
      const double due = imposed_at(l, imposed);
      top += weight * due * shear_in(layers, l), bottom += weight * due * due;
    }
    return top / bottom;
  }

  void stresses(ViscosityResult& r) const {
    const int x = flow_.along, z = flow_.gradient, y = flow_.across();
    std::vector<double> ratio, first, second;
    for (const Block& block : blocks_) {
      const Tensor t = stress_in(block.layers, averaged_).back().mean;
      first.push_back(component(t, x, x) - component(t, z, z));
      second.push_back(component(t, z, z) - component(t, y, y));
      ratio.push_back(stress_ratio(block.layers, r.imposed));
    }
    r.stress = stress_in(all_.layers, averaged_);
    const Tensor& t = r.stress.back().mean;
    r.pressure = -(t[0] + t[4] + t[8]) / 3;
    r.normal_1 = {component(t, x, x) - component(t, z, z), mean_of(first).error};
    r.normal_2 = {component(t, z, z) - component(t, y, y), mean_of(second).error};
    r.stress_ratio = {stress_ratio(all_.layers, r.imposed), mean_of(ratio).error};
  }

  ProfileRow row(int l, double imposed) const {
    const LayerSums& layer = all_.layers[l];
    const double s = layer.place / layer.fluid.mass, s2 = layer.place2 / layer.fluid.mass;
    return {flow_.low + (s + (turned(l) ? 1 : 0)) * flow_.gap(),
            velocity(layer.fluid),
            sign(l) * fit_.at(s, s2),
            velocity(layer.grains),
            shear_in(all_.layers, l),
            imposed_at(l, imposed),
            stretch_ * layer.volume / all_.samples * n_ / (flow_.area * (flow_.high - flow_.low))};
  }

  std::vector<Block> blocks_;
  const Config& c_;
  const PlaneFlow& flow_;
  double reach_;  ///< kernel radius, m
  int n_;
  Block all_;
  double stretch_ = 1;  ///< volume between the walls or of the domain over that of the particles
  std::vector<int> averaged_, inner_;
  Fit fit_;
};

}  // namespace

ViscosityResult evaluate(const Layers& layers, const Config& config, double reach) {
  return Evaluation(layers, config, reach).result();
}

std::string resolved_viscosities(double phi) {
  constexpr double phi_m = 0.64;
  const double einstein = 1 + 2.5 * phi, krieger = phi < phi_m ? std::pow(1 - phi / phi_m, -2.5 * phi_m)
                                                               : std::numeric_limits<double>::infinity();
  return fmt::format(
      "resolved spheres at {:.3g} % have {:.2f} (Einstein) to {:.2f} (Krieger-Dougherty, phi_m = {})",
      100 * phi, einstein, krieger, phi_m);
}

std::string relative_caveat(double phi, bool by_law) {
  return fmt::format(
      "not the viscosity of a suspension: grains are smaller than the kernel and do not strain the fluid "
      "between them, so the excess over 1 is the stress of contacts and lubrication{}; {}",
      by_law ? " on top of the law of couple.suspension_viscosity" : " alone", resolved_viscosities(phi));
}

std::vector<Quantity> quantities_of(const ViscosityResult& r, const PlaneFlow& flow) {
  std::vector<Quantity> out;
  if (r.accepted())
    out = {{"viscosity", "Pa s", r.viscosity.mean}, {"viscosity_error", "Pa s", r.viscosity.error}};
  const bool images = flow.kind == PlaneFlowKind::lees_edwards;
  out.push_back(images           ? Quantity{"shear_stress", "Pa", r.imposed}
                : flow.sheared() ? Quantity{"wall_shear_stress", "Pa", r.imposed}
                                 : Quantity{"force_density", "N/m3", r.imposed});
  for (const Quantity& q : std::vector<Quantity>{{"r_squared", "-", r.r_squared},
                                                 {"peak_velocity", "m/s", r.peak},
                                                 {"reynolds_number", "-", r.reynolds},
                                                 {"mach_number", "-", r.mach},
                                                 {"drift", "-", r.drift},
                                                 {"drift_limit", "-", r.drift_limit}})
    out.push_back(q);
  if (flow.walled()) {
    out.push_back({"slip_length", "m", r.slip_length});
    out.push_back({"offset", "m", r.offset});
  }
  if (!images) {
    out.push_back({"shear_stress_over_imposed", "-", r.stress_ratio.mean});
    out.push_back({"shear_stress_over_imposed_error", "-", r.stress_ratio.error});
  }
  for (const Quantity& q : std::vector<Quantity>{{"normal_stress_difference_1", "Pa", r.normal_1.mean},
                                                 {"normal_stress_difference_1_error", "Pa", r.normal_1.error},
                                                 {"normal_stress_difference_2", "Pa", r.normal_2.mean},
                                                 {"normal_stress_difference_2_error", "Pa", r.normal_2.error},
                                                 {"pressure", "Pa", r.pressure},
                                                 {"grain_concentration", "-", r.concentration},
                                                 {"blocks", "-", double(r.blocks)},
                                                 {"samples", "-", double(r.samples)}})
    out.push_back(q);
  return out;
}

}  // namespace bedload
