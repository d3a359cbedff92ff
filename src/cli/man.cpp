// The manual page.

#include <fmt/format.h>

#include "options.hpp"
#include "shell.hpp"

namespace bedload {
namespace {

/// Text with roff control characters escaped.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if ((c == '.' || c == '\'') && (out.empty() || out.back() == '\n'))
      out += std::string("\\&") + c;
    else
      out += c;
  }
  return out;
}

/// The value of an option: {single,mixed,double}, DIR, INT.
std::string value_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto brace = type.find('{'), colon = type.find(':');
  return brace != type.npos ? type.substr(brace) : type.substr(0, colon);
}

/// An option as a list entry.
std::string entry(const CLI::Option& option) {
  const bool place = option.get_positional();
  std::string out = fmt::format(".TP\n\\fB{}\\fR", plain(option.get_name(place, !place)));
  if (!place && option.get_items_expected_max() > 0)
    out += fmt::format(" \\fI{}\\fR", plain(value_of(option)));
  return out + "\n" + plain(option.get_description()) + ".\n";
}

std::string synopsis(const CLI::App& command) {
  std::string out = fmt::format("\\fBbedload {}\\fR", command.get_name());
  for (const CLI::Option* option : command.get_options())
    if (option->get_positional()) {
      const std::string name = plain(option->get_name(true, false));
      out += option->get_required() ? fmt::format(" \\fI{}\\fR", name) : fmt::format(" [\\fI{}\\fR]", name);
    }
  return out + " [\\fIoptions\\fR]\n";
}

constexpr const char* kRest = R"(.SH EXIT STATUS
.TP
.B 0
Success.
.TP
.B 2
Bad input, or a file that cannot be read or written; the message names file, line and key.
.TP
.B 3
The simulation failed; the message names particle, position, time and the last good checkpoint.
.TP
.B 4
More fluid, grains or free bodies than run.max_lost left the domain where there is no outlet.
.TP
.B 5
The fit of a viscometer was rejected.
.TP
.B 130
Stopped by a signal, with a checkpoint.
.SH SIGNALS
SIGINT, SIGTERM and SIGHUP end a run after the current step with a checkpoint;
.B \-\-restart latest
continues it bit for bit.
.SH FILES
A results folder holds fluid.vtkhdf, grains.vtkhdf and walls.vtkhdf (for ParaView), probes/*.csv, bodies/*.csv,
diagnostics.csv, checkpoints/, case.resolved.toml and summary.json.
Settled beds are cached in $XDG_CACHE_HOME/bedload, by default ~/.cache/bedload.
.SH EXAMPLES
.nf
bedload demo
bedload new dam_break dam.toml
bedload check dam.toml \-\-preview look
bedload run dam.toml \-\-out results/dam \-\-set grain.d=3mm
bedload run dam.toml \-\-out results/dam \-\-restart latest
bedload viscometer slurry.toml \-\-relative
bedload drag \-\-fractions 0.2,0.4 \-\-nodes 16
bedload convert CaseDambreak_Def.xml \-\-out dam.toml
bedload list fluid
.fi
)";

}  // namespace

std::string man_page(const CLI::App& app) {
  std::string out = fmt::format(".TH BEDLOAD 1 \"\" \"bedload {}\" \"User Commands\"\n", version());
  out += ".SH NAME\nbedload \\- free\\-surface flow with grains, by SPH and DEM\n.SH SYNOPSIS\n";
  const auto commands = app.get_subcommands([](const CLI::App*) { return true; });
  for (const CLI::App* command : commands) out += synopsis(*command) + ".br\n";
  out += ".SH DESCRIPTION\n" + plain(app.get_description()) +
         "\nA case is one TOML file; \\fBbedload list\\fR shows its keys.\n.SH OPTIONS\n";
  for (const CLI::Option* option : app.get_options()) out += entry(*option);
  for (const CLI::App* command : commands) {
    out += fmt::format(".SH \"bedload {}\"\n{}.\n", plain(command->get_name()),
                       plain(command->get_description()));
    for (const CLI::Option* option : command->get_options()) out += entry(*option);
  }
  return out + kRest;
}

}  // namespace bedload
