#include "xml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "bedload/case/words.hpp"
#include "bedload/core/error.hpp"
#include "bedload/output/files.hpp"
#include "src/case/shortened.hpp"

namespace bedload {

std::string missing_reason(const std::string& program, const std::string& name) {
  for (const Word& word : words_named(name))
    if (word.program == program && word.keys.empty()) return std::string(word.note);
  return "";
}

std::vector<std::string> words_in(const std::string& text, const std::string& separators) {
  std::vector<std::string> out(1);
  for (const char c : text)
    if (separators.find(c) == separators.npos)
      out.back() += c;
    else if (!out.back().empty())
      out.emplace_back();
  if (out.back().empty()) out.pop_back();
  return out;
}

XmlReader::XmlReader(const std::filesystem::path& file) : file_(file) {
  text_ = read_file(file);
  const pugi::xml_parse_result result = document_.load_buffer(text_.data(), text_.size());
  if (!result) {
    const auto lines =
        std::count(text_.begin(), text_.begin() + std::min<std::size_t>(result.offset, text_.size()), '\n');
    throw CaseError(
        fmt::format("{}:{}: is not valid XML: {}", file.string(), lines + 1, result.description()));
  }
}

int XmlReader::line(const pugi::xml_node& node) const {
  const auto offset = node.offset_debug();
  if (offset < 0) return 1;
  return 1 +
         int(std::count(text_.begin(), text_.begin() + std::min<std::size_t>(offset, text_.size()), '\n'));
}

std::string XmlReader::place(const pugi::xml_node& node) const {
  return fmt::format("{}:{}: <{}>", file_.string(), line(node), node.name());
}

void XmlReader::fail(const pugi::xml_node& node, const std::string& what) const {
  throw CaseError(place(node) + " " + what);
}

double XmlReader::number(const pugi::xml_node& node, const char* attribute) const {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found) fail(node, fmt::format("must have the attribute {}, a number", attribute));
  std::string_view text = found.value();
  if (text.starts_with('#')) text.remove_prefix(1);
  try {
    return variables.value(text);
  } catch (const CaseError& error) {
    fail(node, fmt::format("{}=\"{}\" must be a number or an expression: {}", attribute,
                           shortened(found.value()), error.what()));
  }
}

double XmlReader::number(const pugi::xml_node& node, const char* attribute, double fallback) const {
  return node.attribute(attribute) ? number(node, attribute) : fallback;
}

int XmlReader::whole(const pugi::xml_node& node, const char* attribute, int most) const {
  const double value = number(node, attribute);
  if (!(value >= 0 && value <= most))
    fail(node, fmt::format("{}=\"{}\" must be within 0..{}", attribute,
                           shortened(node.attribute(attribute).value()), most));
  return int(value);
}

int XmlReader::whole_or(const pugi::xml_node& node, const char* attribute, int fallback) const {
  return node.attribute(attribute) ? whole(node, attribute) : fallback;
}

Vec3d XmlReader::vector(const pugi::xml_node& node, double fallback) const {
  return {number(node, "x", fallback), number(node, "y", fallback), number(node, "z", fallback)};
}

Vec3d XmlReader::vector(const pugi::xml_node& node, const char* name) const {
  return vector(child(node, name));
}

pugi::xml_node XmlReader::child(const pugi::xml_node& node, const char* name) const {
  const pugi::xml_node found = node.child(name);
  if (!found) fail(node, fmt::format("must hold an element <{}>", name));
  return found;
}

bool XmlReader::flag(const pugi::xml_node& node, const char* attribute, bool fallback) const {
  const pugi::xml_attribute found = node.attribute(attribute);
  if (!found) return fallback;
  const std::string text = found.value();
  if (text == "true" || text == "yes") return true;
  if (text == "false" || text == "no") return false;
  return number(node, attribute) != 0;
}

void XmlReader::leave(const pugi::xml_node& node, const std::string& reason) {
  const std::string known = reason.empty() ? missing_reason("DualSPHysics", node.name()) : reason;
  left.push_back(place(node) + ": " + (known.empty() ? "there is no counterpart" : known));
}

}  // namespace bedload
