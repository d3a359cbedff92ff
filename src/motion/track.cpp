#include "src/motion/track.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bedload/core/error.hpp"
#include "src/motion/formula_track.hpp"
#include "src/motion/scaled_track.hpp"
#include "src/motion/spline.hpp"

namespace bedload {
namespace {

using std::numbers::pi;

class Straight final : public Track {
 public:
  explicit Straight(const Vec3d& velocity) : velocity_(velocity) {}
  TrackPoint at(double s) const override { return {.shift = {velocity_ * s, velocity_, {}}, .turn = {}}; }

 private:
  Vec3d velocity_;
};

class Oscillation final : public Track {
 public:
  Oscillation(const Vec3d& amplitude, double frequency) : amplitude_(amplitude), w_(2 * pi * frequency) {}
  TrackPoint at(double s) const override {
    const double sine = std::sin(w_ * s), cosine = std::cos(w_ * s);
    return {.shift = {amplitude_ * sine, amplitude_ * (w_ * cosine), amplitude_ * (-w_ * w_ * sine)},
            .turn = {}};
  }

 private:
  Vec3d amplitude_;
  double w_;
};

class SteadyTurn final : public Track {
 public:
  explicit SteadyTurn(const Vec3d& omega) : omega_(omega) {}
  TrackPoint at(double s) const override { return {.shift = {}, .turn = {omega_ * s, omega_, {}}}; }
  bool turns() const override { return true; }

 private:
  Vec3d omega_;
};

/// Splines through the rows of a table.
class TableTrack final : public Track {
 public:
  TableTrack(const std::vector<MotionRow>& rows, bool monotone) {
    std::vector<double> t;
    for (const MotionRow& row : rows) t.push_back(row[0]);
    begin_ = t.front(), end_ = t.back();
    for (int k = 1; k < 7; ++k) {
      std::vector<double> y;
      for (const MotionRow& row : rows) y.push_back(k > 3 ? row[k] * pi / 180 : row[k]);
      turns_ = turns_ || (k > 3 && std::any_of(y.begin(), y.end(), [](double v) { return v != 0; }));
      columns_.emplace_back(t, std::move(y), monotone);
    }
  }
  TrackPoint at(double s) const override {
    TrackPoint p;
    for (int k = 0; k < 3; ++k) {
      fill(p.shift, k, columns_[k].at(s));
      if (turns_) fill(p.turn, k, columns_[3 + k].at(s));
    }
    return p;
  }
  bool turns() const override { return turns_; }
  double begin() const override { return begin_; }
  double end() const override { return end_; }

 private:
  static void fill(Jet& jet, int k, const Spline::Value& v) {
    jet.value[k] = v.y, jet.rate[k] = v.rate, jet.rate2[k] = v.rate2;
  }
  std::vector<Spline> columns_;
  double begin_ = 0, end_ = 0;
  bool turns_ = false;
};

}  // namespace

std::unique_ptr<Track> make_track(const MotionPart& m, double span) {
  switch (m.kind) {
    case MotionKind::fixed:
      break;
    case MotionKind::velocity:
      if (m.scaled()) return std::make_unique<ScaledTrack>(m.velocity, Vec3d{}, m.factor, span);
      return std::make_unique<Straight>(m.velocity);
    case MotionKind::oscillation:
      return std::make_unique<Oscillation>(m.amplitude, m.frequency);
    case MotionKind::rotation:
      if (m.scaled()) return std::make_unique<ScaledTrack>(Vec3d{}, m.axis * m.rate, m.factor, span);
      return std::make_unique<SteadyTurn>(m.axis * m.rate);
    case MotionKind::table:
      return std::make_unique<TableTrack>(m.rows, m.spline == TableSpline::monotone);
    case MotionKind::formula:
    case MotionKind::piston:
    case MotionKind::flap:
      return std::make_unique<FormulaTrack>(m.displacement, m.rotation, span);
  }
  return nullptr;
}

}  // namespace bedload
