#include "bedload/case/places.hpp"

#include "bedload/case/section.hpp"

namespace bedload {

Places::Places(const Value& root) { add(root, ""); }

void Places::add(const Value& value, const std::string& path) {
  all_[path] = value.place();
  const auto below = [&](const std::string& part) { return path.empty() ? part : path + "." + part; };
  if (const auto* table = value.get<Value::Table>())
    for (const auto& [name, member] : *table) add(member, below(name));
  const auto* list = value.get<Value::Array>();
  if (!list || list->empty() || !list->front().get<Value::Table>())
    return;  // numbers stand where their list does
  for (std::size_t k = 0; k < list->size(); ++k) add((*list)[k], below(std::to_string(k)));
}

std::string Places::of(std::string_view path) const {
  for (;;) {
    if (const auto found = all_.find(path); found != all_.end()) return found->second;
    if (path.empty()) return "";
    const auto dot = path.rfind('.');
    path = path.substr(0, dot == path.npos ? 0 : dot);
  }
}

}  // namespace bedload
