// Completion for bash.

#include <fmt/format.h>

#include <algorithm>

#include "bedload/case/parameters.hpp"
#include "shell.hpp"

namespace bedload {
namespace {

/// "auto cpu cuda" for an option with the values "{auto,cpu,cuda}"; empty if they are not listed.
std::string values_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const auto from = type.find('{'), to = type.find('}');
  if (from == type.npos || to == type.npos) return "";
  std::string values = type.substr(from + 1, to - from - 1);
  std::replace(values.begin(), values.end(), ',', ' ');
  return values;
}

/// The command of the script that completes the value of an option.
std::string completed(const CLI::Option& option) {
  const std::string type = option.get_type_name(), values = values_of(option);
  if (!values.empty()) return fmt::format("_bedload_words '{}'", values);
  if (type == "KEY=VALUE") return "_bedload_keys";
  if (type.ends_with("CASE.toml")) return "_bedload_files toml";
  if (type == "FILE") return "_bedload_files";
  if (type == "DIR") return "_bedload_folders";
  return ":";
}

std::string names_of(const CLI::Option& option, char separator) {
  std::string names;
  const auto add = [&](const std::string& name) {
    names += (names.empty() ? "" : std::string(1, separator)) + name;
  };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  return names;
}

/// All keys in the form of --set, with index 0 in lists: wall.body.0.mu.
std::string keys() {
  std::string out;
  for (const ParameterRow& row : parameter_table()) {
    std::string key = row.path;
    for (auto at = key.find("[]"); at != key.npos; at = key.find("[]")) key.replace(at, 2, ".0");
    out += key + "=\n";
  }
  return out;
}

constexpr const char* kHead = R"(# Completion of bedload for bash. Either of
#   source <(bedload completion bash)
#   bedload completion bash > ~/.local/share/bash-completion/completions/bedload
_bedload_words() { COMPREPLY=($(compgen -W "$1" -- "$word")); }
_bedload_folders() { compopt -o filenames 2>/dev/null; COMPREPLY=($(compgen -d -- "$word")); }
_bedload_files() {
  compopt -o filenames 2>/dev/null
  COMPREPLY=($(compgen -d -- "$word"))
  if [[ $1 ]]; then COMPREPLY+=($(compgen -f -X "!*.$1" -- "$word")); else COMPREPLY=($(compgen -f -- "$word")); fi
}
)";

constexpr const char* kTail = R"(
_bedload() {
  # The shell also splits words at "=", which the value of --set contains.
  local line=${COMP_LINE:0:COMP_POINT} word before command
  local -a words
  read -ra words <<< "$line"
  [[ $line == *' ' ]] && words+=('')
  word=${words[-1]} before=${words[-2]:-} command=${words[1]:-}
  COMPREPLY=()
  ((${#words[@]} > 2)) || command=''
  case $command in
)";

}  // namespace

std::string bash_completion(const CLI::App& app) {
  std::string out = kHead, commands;
  out += fmt::format(
      "_bedload_keys() {{\n  compopt -o nospace 2>/dev/null\n  COMPREPLY=($(compgen -W '{}' -- "
      "\"$word\"))\n}}\n",
      keys());
  out += kTail;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    commands += " " + command->get_name();
    std::string options, places = ":";
    out += fmt::format("    {})\n      case $before in\n", command->get_name());
    for (const CLI::Option* option : command->get_options()) {
      if (option->get_positional()) {
        if (places == ":") places = completed(*option);
        continue;
      }
      options += " " + names_of(*option, ' ');
      if (option->get_items_expected_max() > 0)
        out += fmt::format("        {}) {}; return ;;\n", names_of(*option, '|'), completed(*option));
    }
    out += fmt::format("      esac\n      if [[ $word == -* ]]; then _bedload_words '{}'; else {}; fi ;;\n",
                       options.substr(1), places);
  }
  std::string options;
  for (const CLI::Option* option : app.get_options()) options += " " + names_of(*option, ' ');
  return out + fmt::format("    *) _bedload_words '{}{}' ;;\n  esac\n}}\ncomplete -F _bedload bedload\n",
                           commands.substr(1), options);
}

}  // namespace bedload
