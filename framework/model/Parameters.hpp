#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace kiln {

/// Which values a live parameter may take; what its key in the input allows.
enum class Allowed { any, not_negative, positive };

/// One live parameter µ of a model: the value the model reads at its next evaluation.
struct Parameter {
  std::string name;  ///< path below `model` in the input, e.g. "heat_source.power"
  std::string unit;  ///< SI unit, "1" for a pure number
  double* value;     ///< owned by the component that lists it
  Allowed allowed = Allowed::any;
  std::vector<double*> mirrors = {};  ///< take every new value too

  /// What is wrong with a value, e.g. "below 0"; empty: it is finite and allowed.
  std::string trouble(double proposed) const;
  /// What may follow "a power in W" in a message, e.g. " at least 0"; empty: nothing.
  const char* range() const;
};

/// The named, typed, live parameters of a model (µ of Eq. 12). A new value takes effect at the next evaluation;
/// nothing is rebuilt. Components add theirs when they are built.
class Parameters {
 public:
  /// `value` must live as long as this set. Throws std::logic_error for a name listed twice.
  void add(std::string name, std::string unit, double* value, Allowed allowed = Allowed::any);
  /// Adds the parameters of a component, each name behind `prefix` and a dot.
  void add(std::string_view prefix, const Parameters& component);
  /// Binds parameters of the same names, those of another model of the same physics: a value set here is set there too.
  /// Throws std::logic_error unless both sets have the same names.
  void mirror(const Parameters& other);
  /// Throws InputError that lists the known names for an unknown one.
  double get(std::string_view name) const;
  /// Throws InputError for an unknown name and for a value that is not finite or not allowed.
  void set(std::string_view name, double value);
  const std::vector<Parameter>& list() const { return parameters_; }

 private:
  const Parameter& find(std::string_view name) const;
  std::vector<Parameter> parameters_;
};

}  // namespace kiln
