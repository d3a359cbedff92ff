#include "scaling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace bedload {
namespace {

double particles(const Counts& n) { return double(n.fluid + n.walls + n.grains); }

const ScalingRow& first_of(const ScalingRow& row, const std::vector<ScalingRow>& rows) {
  const ScalingRow* first = &row;
  for (const ScalingRow& other : rows)
    if (other.name == row.name && other.precision == row.precision && other.kind == row.kind &&
        other.ranks < first->ranks)
      first = &other;
  return *first;
}

}  // namespace

void ScalingRow::share(const std::vector<RankReport>& from, const std::vector<RankReport>& to, int steps,
                       double seconds) {
  if (to.empty()) return;
  double waited = 0, ghosts = 0, most = 0, all = 0, bytes = 0;
  migrated = 0;
  for (std::size_t r = 0; r < to.size(); ++r) {
    waited += to[r].waited - from[r].waited;
    ghosts += double(to[r].ghosts);
    most = std::max(most, particles(to[r].own)), all += particles(to[r].own);
    bytes = std::max(bytes, to[r].sent - from[r].sent);
    migrated += double(to[r].migrated - from[r].migrated) / steps;
  }
  const auto count = double(to.size());
  wait_percent = 100 * waited / (count * seconds);
  ghost_percent = 100 * ghosts / all;
  imbalance = most * count / all;
  exchanges = double(to[0].exchanges - from[0].exchanges) / steps;
  sent_mb = 1e-6 * bytes / steps;
}

double speed_up(const ScalingRow& row, const std::vector<ScalingRow>& rows) {
  return row.rate / first_of(row, rows).rate;
}

double efficiency_percent(const ScalingRow& row, const std::vector<ScalingRow>& rows) {
  return 100 * speed_up(row, rows) * first_of(row, rows).ranks / row.ranks;
}

std::vector<std::vector<std::string>> scaling_table(const std::string& kind,
                                                    const std::vector<ScalingRow>& rows) {
  std::vector<std::vector<std::string>> table{{"benchmark", "precision", "ranks", "ms/step", "speed-up",
                                               "efficiency", "waits", "ghosts", "imbalance", "exchanges/step",
                                               "MB/step", "migrated/step"}};
  for (const ScalingRow& row : rows) {
    if (row.kind != kind) continue;
    table.push_back({row.name, row.precision, fmt::format("{}", row.ranks), fmt::format("{:.3f}", row.ms),
                     fmt::format("{:.2f}", speed_up(row, rows)),
                     fmt::format("{:.1f} %", efficiency_percent(row, rows)),
                     fmt::format("{:.1f} %", row.wait_percent), fmt::format("{:.1f} %", row.ghost_percent),
                     fmt::format("{:.3f}", row.imbalance), fmt::format("{:.1f}", row.exchanges),
                     fmt::format("{:.3g}", row.sent_mb), fmt::format("{:.3g}", row.migrated)});
  }
  return table;
}

void add_scaling(const ScalingRow& row, const std::vector<ScalingRow>& rows, nlohmann::ordered_json& to) {
  to["ranks"] = row.ranks;
  if (!row.kind.empty()) to["scaling"] = row.kind;
  to["speed_up"] = speed_up(row, rows);
  to["efficiency_percent"] = efficiency_percent(row, rows);
  to["wait_percent"] = row.wait_percent;
  to["ghost_percent"] = row.ghost_percent;
  to["imbalance"] = row.imbalance;
  to["exchanges_per_step"] = row.exchanges;
  to["sent_mb_per_step"] = row.sent_mb;
  to["migrated_per_step"] = row.migrated;
}

}  // namespace bedload
