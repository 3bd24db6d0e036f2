#pragma once

#include <Teuchos_ParameterList.hpp>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "framework/base/Error.hpp"

namespace kiln {

class Specification;

/// What one key of an input block may hold. Built by Specification's functions; read by the checker, by
/// `kiln describe`, `kiln template` and the generated reference.
struct Entry {
  enum class Kind {
    real,        ///< double in `unit`
    integer,     ///< int
    flag,        ///< bool
    text,        ///< std::string
    choice,      ///< std::string, one of `choices`
    file,        ///< std::string, an existing file, made absolute against the input's folder
    reals,       ///< Teuchos::Array<double> of `length` entries (0: any)
    integers,    ///< Teuchos::Array<int>, likewise
    texts,       ///< Teuchos::Array<std::string>, likewise
    dictionary,  ///< sublist whose keys are the user's, each a std::string or a Teuchos::Array<std::string>
    section,     ///< sublist with fixed keys: `nested`
    sections,    ///< list of maps, each with keys `nested`; sublist with sublists "0", "1", …
    component,   ///< sublist with "type", a registered name of `category`, and that component's own keys
    components,  ///< list of such maps; sublist with sublists "0", "1", …
    blocks       ///< no key of its own: every registered name of `category` may stand as a key of this block
  };
  using Value = std::variant<std::monostate, double, int, bool, std::string, std::vector<double>, std::vector<int>,
                             std::vector<std::string>>;

  std::string key;
  Kind kind = Kind::text;
  std::string help;                    ///< one line
  std::string unit = "1";              ///< SI unit of reals
  bool is_difference = false;          ///< a difference of two values: units with a zero of their own do not serve
  Value fallback;                      ///< default; monostate: none
  bool required = true;                ///< false with a fallback, or when it may be left out
  std::optional<double> lower, upper;  ///< range of numbers
  bool open_lower = false, open_upper = false;
  std::vector<std::string> choices;
  int length = 0;
  std::string category;  ///< of components and blocks
  std::shared_ptr<const Specification> nested;
};

/// Refines the entry just added, e.g. `s.real("step", "time step").unit("s").above(0);`.
class EntryBuilder {
 public:
  explicit EntryBuilder(Entry& entry) : entry_(entry) {}
  EntryBuilder& unit(std::string si_unit);
  /// A step or a width, of which degC says nothing: it counts from a zero of its own.
  EntryBuilder& difference();
  EntryBuilder& above(double bound);
  EntryBuilder& at_least(double bound);
  EntryBuilder& below(double bound);
  EntryBuilder& at_most(double bound);
  EntryBuilder& length(int entries);
  /// For a component: the name of the type to take when the key is left out.
  EntryBuilder& defaults_to(Entry::Value value);
  EntryBuilder& defaults_to(const char* value) { return defaults_to(Entry::Value(std::string(value))); }
  // Without these a literal 0 would be a null `const char*`.
  EntryBuilder& defaults_to(int value) { return defaults_to(Entry::Value(value)); }
  EntryBuilder& defaults_to(double value) { return defaults_to(Entry::Value(value)); }
  EntryBuilder& defaults_to(bool value) { return defaults_to(Entry::Value(value)); }
  /// May be left out; the checked list then lacks the key.
  EntryBuilder& optional();

 private:
  Entry& entry_;
};

/// The parameters of a component or a block of the input, declared next to the class that reads them. The checker, the
/// help texts and the reference page are all made from it.
class Specification {
 public:
  EntryBuilder real(std::string key, std::string help);
  EntryBuilder integer(std::string key, std::string help);
  EntryBuilder flag(std::string key, std::string help);
  EntryBuilder text(std::string key, std::string help);
  EntryBuilder choice(std::string key, std::string help, std::vector<std::string> choices);
  EntryBuilder file(std::string key, std::string help);
  EntryBuilder reals(std::string key, std::string help);
  EntryBuilder integers(std::string key, std::string help);
  EntryBuilder texts(std::string key, std::string help);
  /// A block whose keys the user chooses, each with a text or a list of texts.
  EntryBuilder dictionary(std::string key, std::string help);
  EntryBuilder section(std::string key, std::string help, Specification nested);
  EntryBuilder sections(std::string key, std::string help, Specification nested);
  template <class Base>
  EntryBuilder component(std::string key, std::string help) {
    return add(Entry::Kind::component, std::move(key), std::move(help), Base::category);
  }
  template <class Base>
  EntryBuilder components(std::string key, std::string help) {
    return add(Entry::Kind::components, std::move(key), std::move(help), Base::category);
  }
  /// Every registered component of Base may stand as a key of this block.
  template <class Base>
  EntryBuilder blocks(std::string help) {
    return add(Entry::Kind::blocks, {}, std::move(help), Base::category);
  }
  /// A condition over several keys, run once the keys themselves are right. It adds what is wrong, with paths relative
  /// to the block.
  using Check = std::function<void(const Teuchos::ParameterList&, std::vector<Problem>&)>;
  void check(Check condition) { checks_.push_back(std::move(condition)); }

  const std::vector<std::unique_ptr<Entry>>& entries() const { return entries_; }
  const std::vector<Check>& checks() const { return checks_; }

  /// Whether a block of these keys may be left out although it is wanted, since all of them have defaults.
  bool has_defaults_only() const;

 private:
  EntryBuilder add(Entry::Kind kind, std::string key, std::string help, std::string category = {},
                   std::shared_ptr<const Specification> nested = nullptr);
  // Addresses of entries stay valid while more are added.
  std::vector<std::unique_ptr<Entry>> entries_;
  std::vector<Check> checks_;
};

/// What a checked dictionary holds under a key: its text, or all of its texts.
std::vector<std::string> texts_in(const Teuchos::ParameterList& dictionary, const std::string& key);

}  // namespace kiln
