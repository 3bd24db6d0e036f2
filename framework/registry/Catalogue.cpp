#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <tuple>

#include "framework/base/Nearest.hpp"
#include "framework/registry/Library.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln::catalogue {
namespace {

struct Store {
  // Addresses stay valid while plugins add more.
  std::vector<std::unique_ptr<Registration>> registrations;
  std::string library;               ///< whose registrations run now; empty: Kiln's own
  std::vector<std::string> clashes;  ///< of that library
};

Store& store() {
  // A function's static: registrations of other files run before this file's own initialisers.
  static Store instance;
  return instance;
}

std::string origin(const Registration& registration) {
  const std::string place = fmt::format("{}:{}", registration.file, registration.line);
  return registration.library.empty() ? place : fmt::format("{} ({})", registration.library, place);
}

}  // namespace

void add(Registration registration) {
  registration.library = store().library;
  for (const auto& known : store().registrations) {
    if (known->category != registration.category || known->name != registration.name) continue;
    const std::string clash = fmt::format("{} '{}' is registered twice: {} and {}", registration.category,
                                          registration.name, origin(*known), origin(registration));
    if (registration.library.empty()) throw std::logic_error(clash);
    store().clashes.push_back(clash);
    return;
  }
  store().registrations.push_back(std::make_unique<Registration>(std::move(registration)));
}

const Registration& find(const std::string& category, const std::string& name, const std::string& path) {
  for (const auto& known : store().registrations) {
    if (known->category == category && known->name == name) return *known;
  }
  const std::vector<std::string> known = names(category);
  throw InputError(path, fmt::format("there is no {} '{}'", category, name),
                   known.empty() ? "" : fmt::format("one of: {}", fmt::join(known, ", ")), nearest(name, known));
}

std::vector<const Registration*> all() {
  std::vector<const Registration*> sorted;
  for (const auto& known : store().registrations) sorted.push_back(known.get());
  std::sort(sorted.begin(), sorted.end(), [](const Registration* a, const Registration* b) {
    return std::tie(a->category, a->name) < std::tie(b->category, b->name);
  });
  return sorted;
}

std::vector<std::string> names(const std::string& category) {
  std::vector<std::string> result;
  for (const Registration* known : all()) {
    if (known->category == category) result.push_back(known->name);
  }
  return result;
}

void set_library(std::string library) {
  store().library = std::move(library);
  store().clashes.clear();
}

std::vector<std::string> end_library(bool failed) {
  auto& known = store().registrations;
  if (failed || !store().clashes.empty()) {
    known.erase(
        std::remove_if(known.begin(), known.end(), [](const auto& entry) { return entry->library == store().library; }),
        known.end());
  }
  store().library.clear();
  return std::move(store().clashes);
}

}  // namespace kiln::catalogue
