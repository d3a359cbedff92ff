#include "tree.hpp"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <filesystem>

#include "bedload/case/drag_table.hpp"
#include "bedload/case/read.hpp"
#include "bedload/case/section.hpp"
#include "bedload/core/error.hpp"
#include "cli/list.hpp"

namespace nb = nanobind;

namespace bedload {
namespace {

/// Value to Python; `places` gets "file:line" of each value by its path, "wall.body.0.min".
nb::object to_python(const Value& value, const std::string& path, nb::dict& places) {
  if (!path.empty()) places[path.c_str()] = nb::make_tuple(value.source, value.line);
  const auto below = [&](const std::string& part) { return path.empty() ? part : path + "." + part; };
  if (const auto* table = value.get<Value::Table>()) {
    nb::dict out;
    for (const auto& [key, member] : *table) out[key.c_str()] = to_python(member, below(key), places);
    return out;
  }
  if (const auto* array = value.get<Value::Array>()) {
    nb::list out;
    for (std::size_t k = 0; k < array->size(); ++k)
      out.append(to_python((*array)[k], below(std::to_string(k)), places));
    return out;
  }
  if (const auto* flag = value.get<bool>()) return nb::bool_(*flag);
  if (const auto* whole = value.get<std::int64_t>()) return nb::int_(*whole);
  if (const auto* number = value.get<double>()) return nb::float_(*number);
  if (const auto* text = value.get<std::string>()) return nb::str(text->c_str(), text->size());
  throw CaseError(value.place() + ": " + path + " is a date, which no key takes");
}

/// Python to Value. A value without an entry in `places` gets the place of its table or list.
class ToValue {
 public:
  ToValue(const nb::dict& places, std::string source) : places_(places), outside_{std::move(source), 0} {}

  Value operator()(nb::handle object) const { return convert(object, "", outside_); }

 private:
  struct Place {
    std::string source;
    int line;
  };

  Value convert(nb::handle object, const std::string& path, Place at) const {
    if (!path.empty() && places_.contains(path.c_str())) {
      const nb::tuple known = nb::cast<nb::tuple>(places_[path.c_str()]);
      at = {nb::cast<std::string>(known[0]), nb::cast<int>(known[1])};
    }
    const auto below = [&](const std::string& part) { return path.empty() ? part : path + "." + part; };
    Value value{.data = {}, .source = at.source, .line = at.line};
    if (PyDict_Check(object.ptr())) {
      Value::Table table;
      for (const auto [key, member] : nb::cast<nb::dict>(object)) {
        const std::string name = nb::cast<std::string>(key);
        table.emplace(name, convert(member, below(name), at));
      }
      value.data = std::move(table);
    } else if (PyList_Check(object.ptr())) {
      Value::Array array;
      for (const nb::handle item : nb::cast<nb::list>(object))
        array.push_back(convert(item, below(std::to_string(array.size())), at));
      value.data = std::move(array);
    } else if (PyBool_Check(object.ptr())) {
      value.data = nb::cast<bool>(object);
    } else if (PyLong_Check(object.ptr())) {
      value.data = nb::cast<std::int64_t>(object);
    } else if (PyFloat_Check(object.ptr())) {
      value.data = nb::cast<double>(object);
    } else if (PyUnicode_Check(object.ptr())) {
      value.data = nb::cast<std::string>(object);
    } else {
      throw CaseError(value.place() + ": " + path + " = " + nb::cast<std::string>(nb::str(object)) +
                      " must be a number, a text, true or false, or a list or table of these");
    }
    return value;
  }

  const nb::dict& places_;
  Place outside_;
};

}  // namespace

void bind_cases(nb::module_& m) {
  m.def(
      "parse",
      [](const std::string& text, const std::string& name) {
        nb::dict places;
        const nb::object tree = to_python(parse_toml(text, name), "", places);
        return nb::make_tuple(tree, places);
      },
      nb::arg("text"), nb::arg("name"),
      "TOML as nested dicts, and (file, line) of each value by its path. Raises CaseError.");
  m.def(
      "parameters", [] { return list_json(""); }, "All keys of a case, as JSON: `bedload list --json`.");

  m.def(
      "drag_nodes",
      [] {
        const DragTable nodes = drag_nodes();
        return nb::make_tuple(nodes.porosity, nodes.reynolds);
      },
      "Porosities and Reynolds numbers at which a drag law is evaluated.");

  nb::class_<ReadCase>(m, "ReadCase", "A case that was read and checked, with every default filled in.")
      .def_prop_ro(
          "warnings", [](const ReadCase& c) { return c.warnings; }, "A sentence each.")
      .def(
          "toml", [](const ReadCase& c) { return resolved_toml(c.config); }, "The resolved case.");
  m.def(
      "read",
      [](const nb::dict& tree, const nb::dict& places, const std::string& name,
         const std::filesystem::path& checkpoint) {
        ReadCase out;
        out.config = read_case_tree(ToValue(places, name)(tree), name, out.warnings, checkpoint);
        return out;
      },
      nb::arg("tree"), nb::arg("places"), nb::arg("name"), nb::arg("checkpoint") = std::filesystem::path(),
      "Reads, resolves and checks a case. Raises CaseError and FileError.");
}

}  // namespace bedload
