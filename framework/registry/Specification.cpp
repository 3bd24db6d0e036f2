#include "framework/registry/Specification.hpp"

#include <Teuchos_Array.hpp>
#include <algorithm>

namespace kiln {

EntryBuilder& EntryBuilder::unit(std::string si_unit) {
  entry_.unit = std::move(si_unit);
  return *this;
}

EntryBuilder& EntryBuilder::difference() {
  entry_.is_difference = true;
  return *this;
}

EntryBuilder& EntryBuilder::above(double bound) {
  entry_.lower = bound;
  entry_.open_lower = true;
  return *this;
}

EntryBuilder& EntryBuilder::at_least(double bound) {
  entry_.lower = bound;
  entry_.open_lower = false;
  return *this;
}

EntryBuilder& EntryBuilder::below(double bound) {
  entry_.upper = bound;
  entry_.open_upper = true;
  return *this;
}

EntryBuilder& EntryBuilder::at_most(double bound) {
  entry_.upper = bound;
  entry_.open_upper = false;
  return *this;
}

EntryBuilder& EntryBuilder::length(int entries) {
  entry_.length = entries;
  return *this;
}

EntryBuilder& EntryBuilder::defaults_to(Entry::Value value) {
  entry_.fallback = std::move(value);
  entry_.required = false;
  return *this;
}

EntryBuilder& EntryBuilder::optional() {
  entry_.required = false;
  return *this;
}

EntryBuilder Specification::add(Entry::Kind kind, std::string key, std::string help, std::string category,
                                std::shared_ptr<const Specification> nested) {
  auto entry = std::make_unique<Entry>();
  entry->kind = kind;
  entry->key = std::move(key);
  entry->help = std::move(help);
  entry->category = std::move(category);
  entry->nested = std::move(nested);
  entries_.push_back(std::move(entry));
  return EntryBuilder(*entries_.back());
}

bool Specification::has_defaults_only() const {
  return std::all_of(entries_.begin(), entries_.end(), [](const auto& entry) {
    if (!entry->required || entry->kind == Entry::Kind::blocks) return true;
    return entry->kind == Entry::Kind::section && entry->nested->has_defaults_only();
  });
}

EntryBuilder Specification::real(std::string key, std::string help) {
  return add(Entry::Kind::real, std::move(key), std::move(help));
}

EntryBuilder Specification::integer(std::string key, std::string help) {
  return add(Entry::Kind::integer, std::move(key), std::move(help));
}

EntryBuilder Specification::flag(std::string key, std::string help) {
  return add(Entry::Kind::flag, std::move(key), std::move(help));
}

EntryBuilder Specification::text(std::string key, std::string help) {
  return add(Entry::Kind::text, std::move(key), std::move(help));
}

EntryBuilder Specification::choice(std::string key, std::string help, std::vector<std::string> choices) {
  EntryBuilder builder = add(Entry::Kind::choice, std::move(key), std::move(help));
  entries_.back()->choices = std::move(choices);
  return builder;
}

EntryBuilder Specification::file(std::string key, std::string help) {
  return add(Entry::Kind::file, std::move(key), std::move(help));
}

EntryBuilder Specification::reals(std::string key, std::string help) {
  return add(Entry::Kind::reals, std::move(key), std::move(help));
}

EntryBuilder Specification::integers(std::string key, std::string help) {
  return add(Entry::Kind::integers, std::move(key), std::move(help));
}

EntryBuilder Specification::texts(std::string key, std::string help) {
  return add(Entry::Kind::texts, std::move(key), std::move(help));
}

EntryBuilder Specification::dictionary(std::string key, std::string help) {
  return add(Entry::Kind::dictionary, std::move(key), std::move(help));
}

EntryBuilder Specification::section(std::string key, std::string help, Specification nested) {
  return add(Entry::Kind::section, std::move(key), std::move(help), {},
             std::make_shared<const Specification>(std::move(nested)));
}

EntryBuilder Specification::sections(std::string key, std::string help, Specification nested) {
  return add(Entry::Kind::sections, std::move(key), std::move(help), {},
             std::make_shared<const Specification>(std::move(nested)));
}

std::vector<std::string> texts_in(const Teuchos::ParameterList& dictionary, const std::string& key) {
  if (!dictionary.isType<Teuchos::Array<std::string>>(key)) return {dictionary.get<std::string>(key)};
  return dictionary.get<Teuchos::Array<std::string>>(key).toVector();
}

}  // namespace kiln
