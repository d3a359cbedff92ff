#include "settle.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <string_view>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/core/fingerprint.hpp"
#include "bedload/output/output.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "stop.hpp"

namespace bedload {
namespace {

namespace fs = std::filesystem;

fs::path cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "bedload";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "bedload";
  return {};
}

}  // namespace

fs::path settled_file(const Config& config, const Setup& setup, const Device& device) {
  const fs::path folder = cache_folder();
  if (folder.empty()) return {};
  Fingerprint hash;
  hash.add(resolved_toml(settling_case(config)));
  hash.add(config.grain.has_clumps() ? "clumps" : "");  // also those that come in later
  hash.add(version() + "/" + device.backend + (device.avx2 ? "/avx2" : ""));
  hash.add(setup.grains.x);
  hash.add(setup.grains.v);
  hash.add(setup.grains.radius);
  return folder / fmt::format("settled-{:016x}.h5", hash.value());
}

std::optional<SavedState> cached_bed(const Config& config, const Setup& setup, const Device& device) {
  const fs::path file = settled_file(config, setup, device);
  if (file.empty() || !fs::exists(file)) return std::nullopt;
  try {
    return read_checkpoint(file, settling_case(config));
  } catch (const FileError&) {
    return std::nullopt;  // settled_grains() warns
  }
}

SavedState bed_of(const Config& config, const Setup::Grains& grains, const Device& device) {
  Setup setup;
  setup.grains = grains;
  const auto simulation = make_simulation(settling_case(config), setup, device);
  simulation->settle(0, [](double) {});
  return simulation->save_grains();
}

SettledGrains settled_grains(const Config& config, const Setup& setup, const Device& device,
                             Progress& progress, std::vector<std::string>& warnings) {
  const fs::path file = settled_file(config, setup, device);
  const Config dry = settling_case(config);
  if (!file.empty() && fs::exists(file)) {
    try {
      return {read_checkpoint(file, dry), file};
    } catch (const FileError& error) {
      warnings.push_back(fmt::format("cannot use the cached bed, settling again; {}", error.what()));
    }
  }
  Setup grains;
  grains.grains = setup.grains;
  const auto simulation = make_simulation(dry, grains, device);
  const double longest = config.grain.settle_time;
  simulation->settle(longest, [&](double t) {
    if (stop_requested()) throw Stopped{};
    progress.note(fmt::format("settling grains: {:.3g} s, at most {:.3g} s", t, longest));
  });
  const SavedState state = simulation->save_grains();
  if (file.empty()) return {state, {}};
  try {
    fs::create_directories(file.parent_path());
    write_state(file, state, dry);
  } catch (const fs::filesystem_error& error) {
    warnings.push_back(
        fmt::format("{}: cannot cache the settled bed: {}", file.string(), error.code().message()));
  } catch (const FileError& error) {
    warnings.push_back(fmt::format("cannot cache the settled bed; {}", error.what()));
  }
  return {state, {}};
}

}  // namespace bedload
