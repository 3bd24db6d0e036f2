#include "framework/registry/Schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>
#include <vector>

#include "framework/base/Units.hpp"
#include "framework/registry/EntryText.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

using Json = nlohmann::ordered_json;
using Kind = Entry::Kind;

/// A word as a regular expression of ECMA 262.
std::string quoted(const std::string& word) {
  std::string result;
  for (const char c : word) {
    if (std::string("\\^$.|?*+()[]{}/").find(c) != std::string::npos) result += '\\';
    result += c;
  }
  return result;
}

/// A number, alone or with a unit: a symbol of this dimension, or any product, quotient or power of symbols.
std::string quantity_pattern(const std::string& unit) {
  std::vector<std::string> symbols;
  for (const std::string& symbol : symbols_of(parse_unit(unit).dimension)) symbols.push_back(quoted(symbol));
  symbols.emplace_back(R"([^\s0-9.,_:;][^,;]*[ /*·^0-9²³⁻¹⁰⁴⁵⁶⁷⁸⁹][^,;]*)");
  symbols.emplace_back(R"(1/[^,;]+)");
  return fmt::format(R"(^[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?( *({}))?$)", fmt::join(symbols, "|"));
}

void add_bounds(const Entry& entry, Json& schema) {
  if (entry.lower) schema[entry.open_lower ? "exclusiveMinimum" : "minimum"] = *entry.lower;
  if (entry.upper) schema[entry.open_upper ? "exclusiveMaximum" : "maximum"] = *entry.upper;
}

Json text() { return {{"type", {"string", "number", "boolean"}}}; }

Json list_of(Json item) { return {{"type", "array"}, {"items", std::move(item)}}; }

Json null() { return {{"type", "null"}}; }

Json any_of(std::vector<Json> schemas) {
  if (schemas.size() == 1) return schemas.front();
  return {{"anyOf", std::move(schemas)}};
}

struct DefaultValue {
  Json operator()(std::monostate) const { return nullptr; }
  template <class T>
  Json operator()(const T& value) const {
    return value;
  }
};

std::string description(const Entry& entry) {
  const bool real = entry.kind == Kind::real || entry.kind == Kind::reals;
  std::string details = real && entry.unit != "1" ? entry.unit : "";
  const std::string range = range_text(entry);
  if (!range.empty()) details += (details.empty() ? "" : ", ") + range;
  return details.empty() ? entry.help : fmt::format("{} ({})", entry.help, details);
}

/// Writes the schema of one file: once with all that is required, and once for files that include others.
class Writer {
 public:
  Json whole_file(const Specification& specification, const std::string& title) {
    Json complete = block(specification, true), partial = block(specification, false);
    for (Json* variant : {&complete, &partial}) {
      (*variant)["properties"]["include"] = {
          {"description", "files whose entries hold where this one does not give others, relative to it"},
          {"anyOf", {{{"type", "string"}}, list_of({{"type", "string"}})}}};
    }
    return {{"$schema", "http://json-schema.org/draft-07/schema#"},
            {"title", title},
            {"if", {{"type", "object"}, {"required", Json::array({"include"})}}},
            {"then", std::move(partial)},
            {"else", std::move(complete)},
            {"definitions", std::move(definitions_)}};
  }

 private:
  /// An object with the keys of the specification, and `type` if it is a component's.
  Json block(const Specification& specification, bool complete, const std::string& type = {}) {
    Json properties = Json::object(), required = Json::array();
    if (!type.empty()) properties["type"] = {{"const", type}};
    for (const auto& entry : specification.entries()) {
      if (entry->kind == Kind::blocks) {
        for (const std::string& name : catalogue::names(entry->category)) {
          const std::string key = block_key(name);
          if (!properties.contains(key)) properties[key] = named_block(entry->category, name, complete);
        }
        continue;
      }
      properties[entry->key] = property(*entry, complete);
      const bool may_be_missing = entry->kind == Kind::section && entry->nested->has_defaults_only();
      if (complete && entry->required && !may_be_missing) required.push_back(entry->key);
    }
    Json schema = {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
    if (!required.empty()) schema["required"] = std::move(required);
    return schema;
  }

  Json property(const Entry& entry, bool complete) {
    Json schema = value(entry, complete);
    schema["description"] = description(entry);
    if (entry.fallback.index() != 0) schema["default"] = std::visit(DefaultValue(), entry.fallback);
    return schema;
  }

  Json value(const Entry& entry, bool complete) {
    switch (entry.kind) {
      case Kind::real:
        return quantity(entry);
      case Kind::integer: {
        Json schema = {{"type", "integer"}};
        add_bounds(entry, schema);
        return schema;
      }
      case Kind::flag:
        return {{"type", "boolean"}};
      case Kind::text:
        return text();
      case Kind::choice:
        return {{"enum", entry.choices}};
      case Kind::file:
        return {{"type", "string"}, {"minLength", 1}};
      case Kind::reals:
        return of_length(list_of(quantity(entry)), entry.length);
      case Kind::integers: {
        Json item = {{"type", "integer"}};
        add_bounds(entry, item);
        return of_length(list_of(std::move(item)), entry.length);
      }
      case Kind::texts:
        return of_length(list_of(text()), entry.length);
      case Kind::dictionary:
        return any_of({{{"type", "object"}, {"additionalProperties", any_of({text(), list_of(text())})}}, null()});
      case Kind::section:
        return or_nothing(block(*entry.nested, complete), !complete || entry.nested->has_defaults_only());
      case Kind::sections:
        return list(block(*entry.nested, complete), entry);
      case Kind::component:
        return component(entry, complete);
      case Kind::components:
        return list(component(entry, complete), entry);
      case Kind::blocks:
        break;
    }
    throw std::logic_error("an entry without a value: " + entry.key);
  }

  static Json quantity(const Entry& entry) {
    Json number = {{"type", "number"}};
    add_bounds(entry, number);
    return {{"anyOf", {std::move(number), {{"type", "string"}, {"pattern", quantity_pattern(entry.unit)}}}}};
  }

  static Json of_length(Json schema, int length) {
    if (length == 0) return schema;
    schema["minItems"] = length;
    schema["maxItems"] = length;
    return schema;
  }

  static Json or_nothing(Json schema, bool nothing) { return nothing ? any_of({std::move(schema), null()}) : schema; }

  static Json list(Json item, const Entry& entry) {
    Json schema = of_length(list_of(std::move(item)), entry.length);
    if (!entry.required) return any_of({std::move(schema), {{"type", "object"}, {"maxProperties", 0}}});
    if (entry.length == 0) schema["minItems"] = 1;
    return schema;
  }

  /// The block of a component whose key is its name.
  Json named_block(const std::string& category, const std::string& name, bool complete) {
    const Registration& registration = catalogue::find(category, name, "");
    const bool nothing = !complete || registration.specification().has_defaults_only();
    Json schema = or_nothing(reference(category, name, complete), nothing);
    schema["description"] = registration.summary;
    return schema;
  }

  static void add_case(Json& cases, const Json& condition, Json then) {
    Json one = {{"if", condition}, {"then", std::move(then)}};
    cases.push_back(std::move(one));
  }

  /// A type by its name alone, or a block whose `type` says which keys it has.
  Json component(const Entry& entry, bool complete) {
    const std::vector<std::string> names = catalogue::names(entry.category);
    const auto* fallback = std::get_if<std::string>(&entry.fallback);
    std::vector<std::string> alone;
    Json cases = Json::array();
    for (const std::string& name : names) {
      if (!complete || catalogue::find(entry.category, name, "").specification().has_defaults_only()) {
        alone.push_back(name);
      }
      const Json has_type = {{"properties", {{"type", {{"const", name}}}}}, {"required", Json::array({"type"})}};
      add_case(cases, has_type, reference(entry.category, name, complete));
    }
    Json object = {{"type", "object"}, {"properties", {{"type", {{"enum", names}}}}}};
    const Json without_type = {{"not", {{"required", Json::array({"type"})}}}};
    if (!complete) {
      // The type may stand in an included file.
      std::vector<Json> any;
      for (const std::string& name : names) any.push_back(reference(entry.category, name, false));
      if (!any.empty()) add_case(cases, without_type, any_of(std::move(any)));
    } else if (fallback != nullptr) {
      add_case(cases, without_type, reference(entry.category, *fallback, true));
    } else {
      object["required"] = Json::array({"type"});
    }
    if (!cases.empty()) object["allOf"] = std::move(cases);
    std::vector<Json> forms;
    if (!alone.empty()) {
      Json by_name = {{"enum", alone}};
      forms.push_back(std::move(by_name));
    }
    forms.push_back(std::move(object));
    if (fallback != nullptr || !complete) forms.push_back(null());
    return any_of(std::move(forms));
  }

  /// A component's block, defined once for all places where it may stand.
  Json reference(const std::string& category, const std::string& name, bool complete) {
    const std::string key = fmt::format("{}-{}{}", block_key(category), block_key(name), complete ? "" : "-in-part");
    if (defined_.insert(key).second) {
      const Registration& registration = catalogue::find(category, name, "");
      Json schema = block(registration.specification(), complete, name);
      schema["description"] = registration.summary;
      definitions_[key] = std::move(schema);
    }
    return {{"$ref", "#/definitions/" + key}};
  }

  Json definitions_ = Json::object();
  std::set<std::string> defined_;
};

}  // namespace

nlohmann::ordered_json schema_of(const Specification& specification, const std::string& title) {
  return Writer().whole_file(specification, title);
}

}  // namespace kiln
