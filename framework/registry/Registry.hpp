#pragma once

#include <any>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

#include "framework/registry/Specification.hpp"

namespace kiln {

namespace hdf5 {
class Group;
}

/// One registered component, as `kiln list` shows it.
struct Registration {
  std::string category;  ///< Base::category, e.g. "kernel"
  std::string name;      ///< as written in the input, e.g. "cubic spline"
  std::string summary;   ///< one line
  Specification (*specification)();
  std::string file;  ///< where it was registered
  int line;
  std::string library;  ///< the plugin it came with; empty: built in
  std::any factory;     ///< Registry<Base>::Factory
  std::any restore;     ///< Registry<Base>::Restore; empty when the component cannot be restored from a file
};

/// All registered components. Lives in the Kiln library, so that plugins see the same one.
namespace catalogue {
/// Throws std::logic_error that names both places for a name registered twice in a category.
void add(Registration registration);
/// Throws InputError with the nearest known name. `path` is where the name stands in the input.
const Registration& find(const std::string& category, const std::string& name, const std::string& path);
/// Sorted by category, then name.
std::vector<const Registration*> all();
std::vector<std::string> names(const std::string& category);
/// Name of the library whose registrations run now; set while a plugin is loaded.
void set_library(std::string library);
}  // namespace catalogue

/// Creates the components of one kind by name. A component is a class with
///
///     static Specification specification();
///     Component(const Teuchos::ParameterList&, const Base::Context&);
///
/// and, where it can be rebuilt from a reduction file,
///
///     Component(const Teuchos::ParameterList&, const Base::Context&, const hdf5::Group&);
template <class Base>
class Registry {
 public:
  using Context = typename Base::Context;
  using Factory = std::unique_ptr<Base> (*)(const Teuchos::ParameterList&, const Context&);
  using Restore = std::unique_ptr<Base> (*)(const Teuchos::ParameterList&, const Context&, const hdf5::Group&);

  template <class Component>
  static bool add(std::string name, std::string summary, const char* file, int line) {
    Registration registration{
        Base::category, std::move(name), std::move(summary), &Component::specification, file, line, {}, {}, {}};
    registration.factory = Factory([](const Teuchos::ParameterList& list, const Context& context) {
      return std::unique_ptr<Base>(std::make_unique<Component>(list, context));
    });
    if constexpr (std::is_constructible_v<Component, const Teuchos::ParameterList&, const Context&,
                                          const hdf5::Group&>) {
      registration.restore =
          Restore([](const Teuchos::ParameterList& list, const Context& context, const hdf5::Group& group) {
            return std::unique_ptr<Base>(std::make_unique<Component>(list, context, group));
          });
    }
    catalogue::add(std::move(registration));
    return true;
  }

  /// `list` is a checked component block; its "type" picks the class.
  static std::unique_ptr<Base> create(const Teuchos::ParameterList& list, const Context& context) {
    return std::any_cast<Factory>(registration(list).factory)(list, context);
  }

  /// Whether restore() has something to call for this block's type.
  static bool restorable(const Teuchos::ParameterList& list) { return registration(list).restore.has_value(); }
  static std::unique_ptr<Base> restore(const Teuchos::ParameterList& list, const Context& context,
                                       const hdf5::Group& group) {
    return std::any_cast<Restore>(registration(list).restore)(list, context, group);
  }

 private:
  static const Registration& registration(const Teuchos::ParameterList& list) {
    return catalogue::find(Base::category, list.get<std::string>("type"), list.name() + ".type");
  }
};

/// Context of components that need nothing but their block.
struct NoContext {};

}  // namespace kiln

#define KILN_CONCATENATE_INNER(a, b) a##b
#define KILN_CONCATENATE(a, b) KILN_CONCATENATE_INNER(a, b)

/// Registers a class under the name the input uses; stands once, in the class's .cpp file, inside namespace kiln or
/// not.
#define KILN_REGISTER(Base, Component, name, summary)                          \
  [[maybe_unused]] static const bool KILN_CONCATENATE(registered_, __LINE__) = \
      ::kiln::Registry<Base>::add<Component>(name, summary, __FILE__, __LINE__)
