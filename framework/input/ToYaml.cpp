#include <fmt/format.h>
#include <yaml-cpp/emitter.h>

#include <stdexcept>

#include "framework/input/Input.hpp"

namespace kiln {
namespace {

std::string number_text(double value) { return fmt::format("{}", value); }

template <class T, class Write>
bool emit_array(YAML::Emitter& emitter, const Teuchos::ParameterEntry& entry, const Write& write) {
  if (!entry.isType<Teuchos::Array<T>>()) return false;
  emitter << YAML::Flow << YAML::BeginSeq;
  for (const T& value : Teuchos::getValue<Teuchos::Array<T>>(entry)) emitter << write(value);
  emitter << YAML::EndSeq;
  return true;
}

/// Lists of blocks are kept as sublists "0", "1", ….
bool is_list_of_blocks(const Teuchos::ParameterList& list) {
  int index = 0;
  for (auto entry = list.begin(); entry != list.end(); ++entry, ++index) {
    if (list.name(entry) != std::to_string(index) || !list.entry(entry).isList()) return false;
  }
  return index > 0;
}

void emit(YAML::Emitter& emitter, const Teuchos::ParameterList& list) {
  const bool blocks = is_list_of_blocks(list);
  if (list.numParams() == 0) emitter << YAML::Flow;
  if (blocks) {
    emitter << YAML::BeginSeq;
  } else {
    emitter << YAML::BeginMap;
  }
  for (auto it = list.begin(); it != list.end(); ++it) {
    const Teuchos::ParameterEntry& entry = list.entry(it);
    if (!blocks) emitter << YAML::Key << list.name(it) << YAML::Value;
    if (entry.isList()) {
      emit(emitter, list.sublist(list.name(it)));
    } else if (entry.isType<double>()) {
      emitter << number_text(Teuchos::getValue<double>(entry));
    } else if (entry.isType<int>()) {
      emitter << Teuchos::getValue<int>(entry);
    } else if (entry.isType<bool>()) {
      emitter << Teuchos::getValue<bool>(entry);
    } else if (entry.isType<std::string>()) {
      emitter << Teuchos::getValue<std::string>(entry);
    } else if (!emit_array<double>(emitter, entry, number_text) &&
               !emit_array<int>(emitter, entry, [](int value) { return value; }) &&
               !emit_array<std::string>(emitter, entry, [](const std::string& value) { return value; })) {
      throw std::logic_error(fmt::format("{}.{} is of a type that inputs do not hold", list.name(), list.name(it)));
    }
  }
  if (blocks) {
    emitter << YAML::EndSeq;
  } else {
    emitter << YAML::EndMap;
  }
}

}  // namespace

std::string to_yaml(const Teuchos::ParameterList& list) {
  YAML::Emitter emitter;
  emit(emitter, list);
  return std::string(emitter.c_str()) + "\n";
}

}  // namespace kiln
