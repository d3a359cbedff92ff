#include "view.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

namespace bedload {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kProgressInterval = 0.25, kLeastBetweenFrames = 1;  // s
constexpr double kCopyFraction = 0.01, kDrawFraction = 0.02;         // of the wall time
constexpr double kViewerTimeout = 5;                                 // s since the last request

Json quantity(double value, const char* unit) { return {{"value", value}, {"unit", unit}}; }

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

std::string hex(const Colour& c) {
  const auto part = [](float value) { return std::lround(255 * std::clamp(value, 0.0f, 1.0f)); };
  return fmt::format("#{:02x}{:02x}{:02x}", part(c.r), part(c.g), part(c.b));
}

Json hex(const SpeedColours& colours) {
  Json out = Json::array();
  for (const Colour& c : colours) out.push_back(hex(c));
  return out;
}

/// CPU time of this thread, s.
double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace

void LiveView::Table::add(double time, const std::vector<Quantity>& row) {
  if (columns.empty()) columns = row;
  std::vector<double> values;
  for (const Quantity& q : row) values.push_back(q.value);
  if (!times.empty() && (written - 1) % every != 0)
    times.pop_back(), rows.pop_back();  // it was kept only as the last
  times.push_back(time);
  rows.push_back(std::move(values));
  ++written;
  if (times.size() <= kMostRows) return;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    if (k % 2 != 0 && k + 1 != times.size()) continue;
    times[kept] = times[k], rows[kept].swap(rows[k]), ++kept;
  }
  times.resize(kept), rows.resize(kept);
  every *= 2;
}

LiveView::LiveView(std::string name)
    : name_(std::move(name)),
      id_(fmt::format("{}-{}", getpid(), std::chrono::system_clock::now().time_since_epoch().count())) {}

void LiveView::begin(const Config& config, const Device& device, const Simulation& simulation, double end) {
  taker_.emplace(config);
  meter_.emplace(simulation.time(), end, simulation.steps());
  const std::lock_guard drawing(drawing_);
  picture_.emplace(config);
  const std::lock_guard lock(mutex_);
  title_ = config.title;
  device_ = device.backend + ", " + device.name;
  precision_ = config.precision.name();
  state_ = "running";
  progress_ = ProgressLine();
  progress_.time = simulation.time();
  progress_.end = end;
  step_ = simulation.steps();
  counts_ = simulation.counts();
}

void LiveView::add_row(const std::string& table, double time, const std::vector<Quantity>& row) {
  const std::lock_guard lock(mutex_);
  tables_[table].add(time, row);
}

void LiveView::after_step(Simulation& simulation, const StepInfo& info, std::int64_t particle_steps) {
  if (meter_->waited() < kProgressInterval && info.time < meter_->end()) return;
  update_progress(meter_->read(info, particle_steps), simulation);
  if (has_viewers() && Clock::now() >= next_frame_) take_frame(simulation);
}

void LiveView::update_progress(const ProgressLine& line, Simulation& simulation) {
  const Counts counts = simulation.counts();
  const std::int64_t step = simulation.steps();
  const std::lock_guard lock(mutex_);
  progress_ = line;
  limit_ = line.limit;
  step_ = step;
  counts_ = counts;
}

void LiveView::take_frame(Simulation& simulation) {
  const auto from = Clock::now();
  auto frame = std::make_shared<const LiveFrame>(taker_->take(simulation));
  const std::chrono::duration<double> took = Clock::now() - from;
  const double wait =
      std::max({kLeastBetweenFrames, took.count() / kCopyFraction, draw_seconds_ / kDrawFraction});
  next_frame_ =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(wait));
  const std::lock_guard lock(mutex_);
  frame_ = std::move(frame);
  serial_ = ++frames_;
}

void LiveView::end(const std::string& state, const std::string& message, Simulation* simulation) {
  if (simulation && has_viewers()) take_frame(*simulation);
  const std::lock_guard lock(mutex_);
  wall_seconds_ = elapsed();
  if (simulation) {
    progress_.time = simulation->time();
    progress_.fraction = meter_->fraction(progress_.time);
    step_ = simulation->steps();
    counts_ = simulation->counts();
  }
  state_ = state;
  message_ = message;
}

bool LiveView::has_viewers() const {
  return std::chrono::duration<double>(Clock::now() - last_request_.load()).count() < kViewerTimeout;
}

double LiveView::elapsed() const { return std::chrono::duration<double>(Clock::now() - begun_).count(); }

std::string LiveView::status() {
  last_request_ = Clock::now();
  const std::lock_guard lock(mutex_);
  end_seen_ = wall_seconds_.has_value();
  const ProgressLine& p = progress_;
  Json out{{"run", id_},
           {"title", title_.empty() ? name_ : title_},
           {"case", name_},
           {"device", device_},
           {"precision", precision_},
           {"state", state_},
           {"message", message_},
           {"step", step_},
           {"time", quantity(p.time, "s")},
           {"end", quantity(p.end, "s")},
           {"fraction", p.fraction},
           {"dt", quantity(p.dt, "s")},
           {"limit", limit_},
           {"steps_rate", quantity(p.steps_per_second, "1/s")},
           {"particle_steps_rate", quantity(p.particle_steps_per_second, "1/s")},
           {"elapsed", quantity(wall_seconds_.value_or(elapsed()), "s")},
           {"remaining", quantity(p.seconds_left >= 0 ? p.seconds_left : std::nan(""), "s")},
           {"counts", {{"fluid", counts_.fluid}, {"grains", counts_.grains}, {"walls", counts_.walls}}},
           {"picture", {{"serial", serial_}}}};
  if (frame_) {
    Json& picture = out["picture"];
    picture["time"] = quantity(frame_->time, "s");
    picture["top_speed"] = quantity(frame_->top_speed, "m/s");
    picture["colours"] = Json::object();
    if (!frame_->fluid.x.empty()) picture["colours"]["fluid"] = hex(kFluidColours);
    if (!frame_->grains.x.empty()) picture["colours"]["grains"] = hex(kGrainColours);
  }
  return text_of(out);
}

std::string LiveView::tables() const {
  const std::lock_guard lock(mutex_);
  Json out = Json::array();
  for (const auto& [name, table] : tables_) {
    Json columns = Json::array();
    for (const Quantity& q : table.columns) columns.push_back({{"name", q.name}, {"unit", q.unit}});
    out.push_back({{"name", name}, {"rows", table.written}, {"columns", columns}});
  }
  return text_of(out);
}

std::optional<std::string> LiveView::table(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = tables_.find(name);
  if (found == tables_.end()) return {};
  const Table& table = found->second;
  Json columns = Json::array();
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    Json values = Json::array();
    for (const auto& row : table.rows) values.push_back(c < row.size() ? row[c] : std::nan(""));
    columns.push_back({{"name", table.columns[c].name}, {"unit", table.columns[c].unit}, {"values", values}});
  }
  return text_of({{"name", name},
                  {"rows", table.written},
                  {"time", {{"unit", "s"}, {"values", table.times}}},
                  {"columns", columns}});
}

std::optional<std::string> LiveView::picture(LiveSide side) {
  const std::lock_guard drawing(drawing_);
  std::shared_ptr<const LiveFrame> frame;
  std::int64_t serial = 0;
  {
    const std::lock_guard lock(mutex_);
    frame = frame_, serial = serial_;
  }
  if (!frame) return {};
  Drawn& drawn = drawn_[side];
  if (drawn.serial != serial) {
    setpriority(PRIO_PROCESS, 0, 10);  // of this thread only: the run has priority
    const double from = thread_seconds();
    drawn = {serial, picture_->draw(*frame, side).png()};
    draw_seconds_ = thread_seconds() - from;
  }
  return drawn.png;
}

}  // namespace bedload
