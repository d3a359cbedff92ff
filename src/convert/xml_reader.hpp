#pragma once
// An XML file whose elements know their line, with numbers that may be expressions.

#include <filesystem>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "bedload/core/vec.hpp"
#include "variables.hpp"

namespace bedload {

class XmlReader {
 public:
  /// Throws FileError if the file cannot be read, CaseError with line if it is not XML.
  explicit XmlReader(const std::filesystem::path& file);

  pugi::xml_node root() const { return document_.document_element(); }
  const std::filesystem::path& file() const { return file_; }
  int line(const pugi::xml_node& node) const;
  /// "dam.xml:12: <drawbox>".
  std::string place(const pugi::xml_node& node) const;
  [[noreturn]] void fail(const pugi::xml_node& node, const std::string& what) const;

  /// An attribute as a number; "#Dp*2" and "Dp*2" are expressions of `variables`. Throws CaseError if it is
  /// missing or none.
  double number(const pugi::xml_node& node, const char* attribute) const;
  double number(const pugi::xml_node& node, const char* attribute, double fallback) const;
  /// A whole number within 0..most.
  int whole(const pugi::xml_node& node, const char* attribute, int most = 1000000) const;
  int whole_or(const pugi::xml_node& node, const char* attribute, int fallback) const;
  /// x, y, z of an element; those that are missing are `fallback`.
  Vec3d vector(const pugi::xml_node& node, double fallback = 0) const;
  /// The same of a child that must be there.
  Vec3d vector(const pugi::xml_node& node, const char* child) const;
  pugi::xml_node child(const pugi::xml_node& node, const char* name) const;
  /// An attribute that is true, yes or a number other than 0.
  bool flag(const pugi::xml_node& node, const char* attribute, bool fallback) const;

  Variables variables;
  std::vector<std::string> left;  ///< what has no counterpart

  /// Adds a line to `left`; without a reason that of the table of words.
  void leave(const pugi::xml_node& node, const std::string& reason = "");

 private:
  std::filesystem::path file_;
  std::string text_;
  pugi::xml_document document_;
};

/// Why there is nothing like `name` of `program`: a note of the table of words; empty if it has none.
std::string missing_reason(const std::string& program, const std::string& name);

/// Words between '|', ',' or spaces.
std::vector<std::string> words_in(const std::string& text, const std::string& separators);

}  // namespace bedload
