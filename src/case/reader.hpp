#pragma once
// Visitor that fills a Config from a case file.

#include <set>
#include <string>
#include <vector>

#include "bedload/case/config.hpp"
#include "bedload/case/parameters.hpp"
#include "bedload/case/section.hpp"

namespace bedload {

class Reader final : public Parameters {
 public:
  explicit Reader(const Value& root) : scopes_{{&root, ""}} {}
  /// Reads `value` if the file has `key`; throws CaseError if it may not be so.
  void operator()(std::string_view key, Slot value, const About& about) override;
  bool table(std::string_view key, bool) override { return find(key) != nullptr; }
  /// Throws CaseError for a key that no law, shape or kind in this case reads; `options` says why: "by the
  /// chosen options".
  void reject_unread(const std::string& options) const;

 private:
  struct Scope {
    const Value* table;
    std::string prefix;  ///< of full keys: "wall.body."
  };
  std::size_t open_list(std::string_view key, std::size_t have) override;
  void open_item(std::string_view key, std::size_t i) override;
  void close_item() override { scopes_.pop_back(); }
  const Value* find(std::string_view key) const;

  std::vector<Scope> scopes_;
  std::set<const Value*> read_;
};

/// Gives keys of the version before their present names, with a warning each. Where a case has both, the
/// value of --set replaces that of the file, whichever name it has. Throws CaseError where both are in the
/// file, or both from --set.
void rename_keys(Value& root, std::vector<std::string>& warnings);

/// Values where a case gives no key: the defaults of its preset, and those that its fluid.model and
/// fluid.variable_h bring.
Config defaults_of(const Value& root);

/// Throws CaseError for the first key of the file that is no parameter.
void reject_unknown(const Value& root);

}  // namespace bedload
