#pragma once
// The commands of a LIGGGHTS script, with their variables.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "bedload/core/vec.hpp"
#include "variables.hpp"

namespace bedload {

/// Values of ${name} and v_name.
struct ScriptVariables {
  Variables numbers;
  std::map<std::string, std::string> texts;
};

/// One command of a script. Words are counted from 0, the name of the command; variables have the value of
/// the time at which it is read. Errors are CaseErrors with file, line and command.
class Command {
 public:
  Command(const std::string& file, int line, std::vector<std::string> words, const ScriptVariables& variables,
          std::vector<std::string>& left)
      : file_(file), line_(line), words_(std::move(words)), variables_(variables), left_(left) {}

  std::size_t size() const { return words_.size(); }
  std::string word(std::size_t at) const;
  double number(std::size_t at) const;
  /// Within 0..100000.
  int whole(std::size_t at) const;
  Vec3d vector(std::size_t at) const { return {number(at), number(at + 1), number(at + 2)}; }
  /// The place after a keyword; 0 if it is not there.
  std::size_t after(const std::string& keyword, std::size_t from = 0) const;

  [[noreturn]] void fail(const std::string& what) const;
  /// Notes what is not converted.
  void leave(const std::string& what, const std::string& reason = "") const;

 private:
  const std::string& file_;
  int line_;
  std::vector<std::string> words_;
  const ScriptVariables& variables_;
  std::vector<std::string>& left_;
};

struct ScriptLine {
  int number = 0;  ///< of its first line in the file, from 1
  std::vector<std::string> words;
};

/// The lines of a script: those that end in '&' joined, without comments.
std::vector<ScriptLine> read_script(const std::filesystem::path& file);

}  // namespace bedload
