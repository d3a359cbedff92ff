#pragma once
// What other programs call the keys of a case, and what to do about things that Bedload does not have.

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace bedload {

struct Word {
  std::string_view program;  ///< whose word it is; empty: of the field
  std::string_view name;     ///< as written there
  std::string_view keys;     ///< or tables that it is here, "inlet, outlet"; empty: there is no such thing
  std::string_view note;     ///< how the keys differ from it; without keys a sentence on what to do instead
  std::string_view within = {};  ///< the only tables in which it means that, "inlet, outlet"; empty: all
};

/// All that are known, program by program.
std::span<const Word> words();

/// Those of that name, whatever its case; '_', '-', spaces and other marks do not count.
std::vector<Word> words_named(std::string_view name);

/// Those keys and tables, one by one.
std::vector<std::string> keys_of(const Word& word);
/// The only tables in which it means that, one by one.
std::vector<std::string> tables_of(const Word& word);

/// What a part of an unknown key means, as the end of a sentence: "what LIGGGHTS calls youngsModulus is
/// grain.E here". Empty if no part is a word.
std::string meaning_of(std::string_view key);

}  // namespace bedload
