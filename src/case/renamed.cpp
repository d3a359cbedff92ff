// Keys that had another name in the version before.

#include <fmt/format.h>

#include "bedload/core/error.hpp"
#include "reader.hpp"

namespace bedload {
namespace {

const std::vector<ParameterRow>& renamed_parameters() {
  static const std::vector<ParameterRow> renamed = [] {
    std::vector<ParameterRow> rows = parameter_table();
    std::erase_if(rows, [](const ParameterRow& row) { return row.formerly.empty(); });
    return rows;
  }();
  return renamed;
}

/// `path`: of the former key from `at` on.
void rename_below(Value& at, std::string_view path, const ParameterRow& row,
                  std::vector<std::string>& warnings) {
  if (auto* list = std::get_if<Value::Array>(&at.data)) {
    for (Value& item : *list) rename_below(item, path, row, warnings);
    return;
  }
  auto* table = std::get_if<Value::Table>(&at.data);
  const auto dot = path.find('.');
  const auto former = table ? table->find(path.substr(0, dot)) : Value::Table::iterator{};
  if (!table || former == table->end()) return;
  if (dot != path.npos) return rename_below(former->second, path.substr(dot + 1), row, warnings);

  const auto [present, free] = table->try_emplace(row.key.substr(row.key.rfind('.') + 1));
  const bool set = former->second.line == 0;  // not by the file
  if (!free && set == (present->second.line == 0))
    throw CaseError(fmt::format("{}: {} is the former name of {}, which is given too; leave it out",
                                former->second.place(), row.formerly, row.key));
  warnings.push_back(fmt::format("{}: {} is now called {}; the next version will not read the former name",
                                 former->second.place(), row.formerly, row.key));
  if (free || set) present->second = std::move(former->second);
  table->erase(former);
}

}  // namespace

void rename_keys(Value& root, std::vector<std::string>& warnings) {
  for (const ParameterRow& row : renamed_parameters()) rename_below(root, row.formerly, row, warnings);
}

}  // namespace bedload
