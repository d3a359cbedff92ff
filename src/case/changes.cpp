// What two resolved cases differ in, as far as it changes what is computed.

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "bedload/case/read.hpp"
#include "bedload/case/section.hpp"
#include "reader.hpp"

namespace bedload {
namespace {

using Leaves = std::map<std::string, std::string>;

void add_leaves(Leaves& to, const Value& at, const std::string& key) {
  const auto* list = at.get<Value::Array>();
  if (const auto* table = at.get<Value::Table>()) {
    for (const auto& [name, member] : *table) add_leaves(to, member, key.empty() ? name : key + "." + name);
  } else if (list && !list->empty() && (*list)[0].get<Value::Table>()) {
    for (std::size_t k = 0; k < list->size(); ++k) add_leaves(to, (*list)[k], fmt::format("{}.{}", key, k));
  } else {
    to[key] = at.text();
  }
}

/// What is written, for how long and from where does not change what is computed.
bool computes(const std::string& key) {
  for (const char* beside :
       {"title", "out.", "probe.", "checkpoint.", "time.end", "run.max_lost", "run.simd", "grain.settle"})
    if (key.starts_with(beside)) return false;
  return !key.ends_with(".file") && !key.ends_with(".step");
}

}  // namespace

std::vector<std::string> changes_between(const std::string& then, const std::string& now) {
  Leaves before, after;
  Value former = parse_toml(then, "checkpoint");
  std::vector<std::string> renamed;
  rename_keys(former, renamed);
  add_leaves(before, former, "");
  add_leaves(after, parse_toml(now, "case"), "");
  std::vector<std::string> changes;
  for (const auto& [key, value] : after) {
    const auto other = before.find(key);
    if (!computes(key) || (other != before.end() && other->second == value)) continue;
    changes.push_back(
        fmt::format("{} = {} ({} then)", key, value, other == before.end() ? "none" : other->second));
  }
  for (const auto& [key, value] : before)
    if (computes(key) && !after.contains(key)) changes.push_back(fmt::format("no {} ({} then)", key, value));
  return changes;
}

}  // namespace bedload
