#include "src/team/process_team.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <type_traits>
#include <utility>

#include "bedload/case/read.hpp"
#include "bedload/core/error.hpp"
#include "bedload/core/fingerprint.hpp"
#include "src/team/packed.hpp"
#include "src/team/team_simulation.hpp"

namespace bedload {
namespace {

enum class Command : int {
  connect,
  make,
  drop,
  step,
  settle,
  start,
  limits,
  growth,
  ranks,
  snapshot,
  rheology,
  diagnostics,
  spectra,
  spectra_peaks,
  measure,
  begin_interval,
  losses,
  body_state,
  save,
  load,
  save_grains,
  load_grains,
};

/// Of what a simulation is made from: the same on all processes.
std::uint64_t fingerprint(const Config& config, const Setup& setup) {
  Fingerprint hash;
  hash.add(resolved_toml(config));
  hash.add(setup.fluid.x), hash.add(setup.fluid.mass);
  hash.add(setup.walls.x);
  hash.add(setup.grains.x), hash.add(setup.grains.radius);
  return hash.value();
}

class ProcessTeam final : public Simulation {
 public:
  ProcessTeam(Processes& all, const Config& config, const Setup& setup, const Device& device,
              const std::string& code, const MakePart& make)
      : all_(all) {
    run(packed(Command::make, fingerprint(config, setup), code),
        [&] { own_ = make(config, setup, device, all_.link()); });
  }
  ~ProcessTeam() override {
    try {
      run(packed(Command::drop), [&] { own_.reset(); });
    } catch (const std::exception&) {  // they are lost, of which others have said so
    }
  }

  StepInfo step() override {
    return run(packed(Command::step), [&] { return own_->step(); });
  }
  void settle(double longest, const std::function<void(double)>& progress) override {
    run(packed(Command::settle, longest), [&] { own_->settle(longest, progress); });
  }
  void start() override {
    run(packed(Command::start), [&] { own_->start(); });
  }
  // known to each rank, without the others
  double time() const override { return own_->time(); }
  std::int64_t steps() const override { return own_->steps(); }
  Counts counts() const override { return own_->counts(); }
  std::vector<StepLimit> substep_limits() const override { return own_->substep_limits(); }
  std::vector<Quantity> numerical_viscosity() const override { return own_->numerical_viscosity(); }
  std::size_t bytes() const override { return own_->bytes(); }
  ParticleBytes field_bytes() const override { return own_->field_bytes(); }
  ParticleBytes scratch_bytes() const override { return own_->scratch_bytes(); }
  std::vector<Quantity> time_spent() const override { return own_->time_spent(); }

  std::vector<StepLimit> limits() override {
    return run(packed(Command::limits), [&] { return own_->limits(); });
  }
  std::size_t growth() override {
    std::size_t sum = 0;
    for (const std::size_t part : all_of(packed(Command::growth), [&] { return own_->growth(); }))
      sum += part;
    return sum;
  }
  std::vector<RankReport> ranks() override {
    std::vector<RankReport> out;
    for (const auto& part : all_of(packed(Command::ranks), [&] { return own_->ranks(); }))
      out.insert(out.end(), part.begin(), part.end());
    return out;
  }
  HostStore snapshot(const std::string& store) override {
    return joined(all_of(packed(Command::snapshot, store), [&] { return own_->snapshot(store); }));
  }
  HostStore rheology(const std::string& store) override {
    return joined(all_of(packed(Command::rheology, store), [&] { return own_->rheology(store); }));
  }
  std::vector<FieldView> fields(const std::string&) override { return {}; }
  std::vector<Quantity> diagnostics() override {
    return run(packed(Command::diagnostics), [&] { return own_->diagnostics(); });
  }
  std::vector<std::vector<Quantity>> spectra() override {
    return run(packed(Command::spectra), [&] { return own_->spectra(); });
  }
  std::vector<std::vector<Quantity>> spectra_peaks() override {
    return run(packed(Command::spectra_peaks), [&] { return own_->spectra_peaks(); });
  }
  std::vector<Quantity> measure(const ProbeConfig& probe) override {
    return run(packed(Command::measure, probe.name), [&] { return own_->measure(probe); });
  }
  void begin_interval(const ProbeConfig& probe) override {
    run(packed(Command::begin_interval, probe.name), [&] { own_->begin_interval(probe); });
  }
  std::vector<Loss> losses() override {
    return run(packed(Command::losses), [&] { return own_->losses(); });
  }
  std::vector<Quantity> body_state(int body) override {
    return run(packed(Command::body_state, body), [&] { return own_->body_state(body); });
  }
  SavedState save() override {
    return joined(all_of(packed(Command::save), [&] { return own_->save(); }));
  }
  void load(const SavedState& state) override {
    run(packed(Command::load, state), [&] { own_->load(state); });
  }
  SavedState save_grains() override {
    return joined(all_of(packed(Command::save_grains), [&] { return own_->save_grains(); }));
  }
  void load_grains(const SavedState& state) override {
    run(packed(Command::load_grains, state), [&] { own_->load_grains(state); });
  }

 private:
  /// What own() returns, while the others do the same; what they answer is in answers_.
  template <class F>
  std::invoke_result_t<F> run(const HostBytes& command, const F& own) {
    all_.tell(command);
    std::exception_ptr error;
    if constexpr (std::is_void_v<std::invoke_result_t<F>>) {
      try {
        own();
      } catch (...) {
        error = std::current_exception();
      }
      answers_ = all_.hear(error);
    } else {
      std::optional<std::invoke_result_t<F>> result;
      try {
        result.emplace(own());
      } catch (...) {
        error = std::current_exception();
      }
      answers_ = all_.hear(error);
      return std::move(*result);
    }
  }
  /// Of all processes, in their order.
  template <class F>
  std::vector<std::invoke_result_t<F>> all_of(const HostBytes& command, const F& own) {
    std::vector<std::invoke_result_t<F>> out{run(command, own)};
    for (HostBytes& answer : std::exchange(answers_, {})) {
      out.push_back(Unpacker(answer).next<std::invoke_result_t<F>>());
      answer = {};
    }
    return out;
  }

  Processes& all_;
  std::unique_ptr<Simulation> own_;
  std::vector<HostBytes> answers_;
};

/// The part of another process, and what process 0 has it do.
class Server {
 public:
  Server(OwnCase given, Processes& all, const MakePart& make)
      : case_(std::move(given)), all_(all), link_(all.link()), make_(make) {}

  HostBytes answer(const HostBytes& message) {
    Unpacker of(message);
    switch (of.next<Command>()) {
      case Command::connect:
        all_.connect(case_.gpu, of.next<GpuData>());
        break;
      case Command::make: {
        const auto number = of.next<std::uint64_t>();
        make(number, of.next<std::string>());
        break;
      }
      case Command::drop:
        part_.reset();
        break;
      case Command::step:
        part_->step();
        break;
      case Command::settle:
        part_->settle(of.next<double>(), [](double) {});
        break;
      case Command::start:
        part_->start();
        break;
      case Command::limits:
        part_->limits();
        break;
      case Command::growth:
        return packed(part_->growth());
      case Command::ranks:
        return packed(part_->ranks());
      case Command::snapshot:
        return packed(part_->snapshot(of.next<std::string>()));
      case Command::rheology:
        return packed(part_->rheology(of.next<std::string>()));
      case Command::diagnostics:
        part_->diagnostics();
        break;
      case Command::spectra:
        part_->spectra();
        break;
      case Command::spectra_peaks:
        part_->spectra_peaks();
        break;
      case Command::measure:
        part_->measure(probe(of.next<std::string>()));
        break;
      case Command::begin_interval:
        part_->begin_interval(probe(of.next<std::string>()));
        break;
      case Command::losses:
        part_->losses();
        break;
      case Command::body_state:
        part_->body_state(of.next<int>());
        break;
      case Command::save:
        return packed(part_->save());
      case Command::load:
        part_->load(of.next<SavedState>());
        break;
      case Command::save_grains:
        return packed(part_->save_grains());
      case Command::load_grains:
        part_->load_grains(of.next<SavedState>());
        break;
    }
    return {};
  }

 private:
  /// The case, or that in which its grains settle, whichever process 0 makes.
  void make(std::uint64_t number, const std::string& code) {
    if (code != case_.code)
      throw DeviceError(
          fmt::format("process {} computes with {}, process 0 with {}, whose results would differ",
                      link_.rank(), case_.code, code));
    if (number == fingerprint(case_.config, case_.setup)) {
      part_ = make_(case_.config, case_.setup, case_.device, link_);
      case_.setup = {};
      return;
    }
    const Config dry = settling_case(case_.config);
    Setup grains;
    grains.grains = case_.setup.grains;
    if (number != fingerprint(dry, grains))
      throw CaseError(fmt::format("process {} has read another case than process 0, or other files for it",
                                  link_.rank()));
    part_ = make_(dry, grains, case_.device, link_);
  }
  const ProbeConfig& probe(const std::string& name) const {
    return *std::ranges::find(case_.config.out.probes, name, &ProbeConfig::name);
  }

  OwnCase case_;
  Processes& all_;
  Link& link_;
  const MakePart& make_;
  std::unique_ptr<Simulation> part_;
};

}  // namespace

void connect(Processes& all, const OwnGpu& gpu, GpuData wanted) {
  all.tell(packed(Command::connect, wanted));
  std::exception_ptr error;
  try {
    all.connect(gpu, wanted);
  } catch (...) {
    error = std::current_exception();
  }
  all.hear(error);
}

std::unique_ptr<Simulation> make_process_team(Processes& all, const Config& config, const Setup& setup,
                                              const Device& device, const std::string& code,
                                              const MakePart& make) {
  return std::make_unique<ProcessTeam>(all, config, setup, device, code, make);
}

void serve(Processes& all, const std::function<OwnCase()>& read, const MakePart& make) {
  std::optional<Server> server;
  for (HostBytes command;;) {
    try {
      if (!server) {
        if (!command.empty()) throw CaseError("this process could not read the case");
        server.emplace(read(), all, make);
      }
      all.answer(command.empty() ? HostBytes() : server->answer(command));
    } catch (...) {
      all.answer(std::current_exception());
    }
    command = all.next();
    if (command.empty()) return;
  }
}

}  // namespace bedload
