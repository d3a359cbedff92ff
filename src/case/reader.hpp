#pragma once
// Visitor that fills a Config from a case file.

#include <set>
#include <string>
#include <vector>

#include "bedload/case/parameters.hpp"
#include "bedload/case/section.hpp"

namespace bedload {

class Reader final : public Parameters {
 public:
  explicit Reader(const Value& root) : scopes_{{&root, ""}} {}
  /// Reads `value` if the file has `key`; throws CaseError if it may not be so.
  void operator()(std::string_view key, Slot value, const About& about) override;
  bool table(std::string_view key, bool) override { return find(key) != nullptr; }
  /// Throws CaseError for a key that no law, shape or kind in this case reads.
  void reject_unread() const;

 private:
  struct Scope {
    const Value* table;
    std::string prefix;  ///< of full keys: "wall.body."
  };
  std::size_t open_list(std::string_view key, std::size_t have) override;
  void open_item(std::string_view key, std::size_t i) override;
  void close_item() override { scopes_.pop_back(); }
  const Value* find(std::string_view key) const;
  void reject_unread(const Value& table, const std::string& prefix) const;

  std::vector<Scope> scopes_;
  std::set<const Value*> read_;
};

/// Gives keys of the version before their present names, with a warning each. A value from another source, as
/// that of --set, takes the place of one that has the present name. Throws CaseError where one source has
/// both.
void rename_keys(Value& root, std::vector<std::string>& warnings);

/// Throws CaseError for the first key of the file that is no parameter.
void reject_unknown(const Value& root);

}  // namespace bedload
