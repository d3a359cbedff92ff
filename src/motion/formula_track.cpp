#include "src/motion/formula_track.hpp"

#include <algorithm>
#include <numbers>

namespace bedload {
namespace {

std::vector<SmoothFormula> triple(const FormulaTrack::Texts& texts, double factor, double span) {
  std::vector<SmoothFormula> all;
  if (std::all_of(texts.begin(), texts.end(), [](const auto& text) { return text == "0"; })) return all;
  for (const std::string& text : texts) all.emplace_back(text, factor, span);
  return all;
}

Jet jet(const std::vector<SmoothFormula>& formulas, double s) {
  Jet jet;
  for (std::size_t k = 0; k < formulas.size(); ++k) {
    const SmoothFormula::Value v = formulas[k].at(s);
    jet.value[int(k)] = v.y, jet.rate[int(k)] = v.rate, jet.rate2[int(k)] = v.rate2;
  }
  return jet;
}

}  // namespace

FormulaTrack::FormulaTrack(const Texts& displacement, const Texts& rotation, double span)
    : displacement_(triple(displacement, 1, span)),
      rotation_(triple(rotation, std::numbers::pi / 180, span)) {}

std::vector<double> FormulaTrack::breaks() const {
  std::vector<double> times;
  for (const auto* formulas : {&displacement_, &rotation_})
    for (const SmoothFormula& formula : *formulas)
      for (const Break& b : formula.breaks()) times.push_back(b.time);
  return times;
}

TrackPoint FormulaTrack::at(double s) const { return {jet(displacement_, s), jet(rotation_, s)}; }

}  // namespace bedload
