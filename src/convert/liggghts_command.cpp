#include "liggghts_command.hpp"

#include <fmt/format.h>

#include <sstream>

#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "case_text.hpp"
#include "xml_reader.hpp"

namespace bedload {

void Command::fail(const std::string& what) const {
  throw CaseError(fmt::format("{}:{}: {} {}", file_, line_, words_[0], what));
}

void Command::leave(const std::string& what, const std::string& reason) const {
  left_.push_back(
      fmt::format("{}:{}: {}: {}", file_, line_, what, reason.empty() ? "there is no counterpart" : reason));
}

std::string Command::word(std::size_t at) const {
  if (at >= size()) fail(fmt::format("must have {} words or more", at + 1));
  std::string out = words_[at];
  for (auto from = out.find("${"); from != out.npos; from = out.find("${", from)) {  // their values
    const auto to = out.find('}', from);
    if (to == out.npos) fail(fmt::format("{} has a bracket that does not close", out));
    const std::string name = out.substr(from + 2, to - from - 2);
    const auto text = variables_.texts.find(name);
    const auto value = variables_.numbers.find(name);
    if (text == variables_.texts.end() && !value)
      fail(fmt::format("uses the variable {}, which has no value", name));
    const std::string with = text != variables_.texts.end() ? text->second : number_text(*value);
    out.replace(from, to - from + 1, with);
    from += with.size();
  }
  return out;
}

double Command::number(std::size_t at) const {
  std::string text = word(at);
  if (text.starts_with("v_")) text = text.substr(2);
  try {
    return variables_.numbers.value(text);
  } catch (const CaseError& error) {
    fail(fmt::format("\"{}\" must be a number: {}", text, error.what()));
  }
}

int Command::whole(std::size_t at) const {
  const double value = number(at);
  if (!(value >= 0 && value <= 100000)) fail(fmt::format("{} must be within 0..100000", word(at)));
  return int(value);
}

std::size_t Command::after(const std::string& keyword, std::size_t from) const {
  for (std::size_t k = from; k < size(); ++k)
    if (words_[k] == keyword) return k + 1;
  return 0;
}

std::vector<ScriptLine> read_script(const std::filesystem::path& file) {
  std::istringstream in(read_text(file));
  std::vector<ScriptLine> out;
  std::string text, whole;
  int number = 0, first = 0;
  while (std::getline(in, text)) {
    ++number;
    if (whole.empty()) first = number;
    if (const auto hash = text.find('#'); hash != text.npos) text.resize(hash);
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    const bool goes_on = !text.empty() && text.back() == '&';
    if (goes_on) text.pop_back();
    whole += ' ' + text;
    if (goes_on) continue;
    if (auto words = words_in(whole, " \t\r"); !words.empty()) out.push_back({first, std::move(words)});
    whole.clear();
  }
  return out;
}

}  // namespace bedload
