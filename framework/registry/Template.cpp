#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "framework/base/Nearest.hpp"
#include "framework/base/Text.hpp"
#include "framework/registry/Describe.hpp"
#include "framework/registry/EntryText.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

using Kind = Entry::Kind;

struct Line {
  std::string text;
  std::string comment;
};

/// Writes the lines of a block, its comments in one column.
class Writer {
 public:
  void comment(const std::string& text) { lines_.push_back({"# " + text, {}}); }

  void type(const std::string& name, const std::string& summary) { put("type: " + yaml_text(name), summary); }

  void block(const Specification& specification) {
    for (const auto& entry : specification.entries()) write(*entry);
  }

  std::string text() const {
    constexpr std::size_t widest = 36;
    std::size_t column = 0;
    for (const Line& line : lines_) {
      if (!line.comment.empty() && line.text.size() <= widest) column = std::max(column, line.text.size());
    }
    std::string text;
    for (const Line& line : lines_) {
      text += line.text;
      if (!line.comment.empty()) {
        text += std::string(column > line.text.size() ? column - line.text.size() : 0, ' ') + "  # " + line.comment;
      }
      text += "\n";
    }
    return text;
  }

 private:
  void put(const std::string& text, const std::string& comment) {
    const bool in_first = !first_.empty();
    const bool takes_dash = in_first && disabled_ == list_disabled_;
    const std::string dash = takes_dash ? first_ : std::string(in_first ? 2 : 0, ' ');
    lines_.push_back({(disabled_ ? "# " : "") + indent_ + dash + text, comment});
    if (!takes_dash) return;
    // The keys after the first one of a list's item.
    first_.clear();
    indent_ += "  ";
  }

  /// "help (unit, range)".
  static std::string remark(const Entry& entry) {
    const bool has_unit = (entry.kind == Kind::real || entry.kind == Kind::reals) && entry.unit != "1";
    std::string details = has_unit ? entry.unit : "";
    std::string values = range_text(entry);
    if (entry.kind == Kind::choice || entry.kind == Kind::component) values = expectation(entry);
    if (!values.empty()) details += (details.empty() ? "" : ", ") + values;
    return details.empty() ? entry.help : fmt::format("{} ({})", entry.help, details);
  }

  static std::string wanted(const Entry& entry) {
    const char* word = entry.required ? "required" : "optional";
    return fmt::format("{}: {}; {}", word, expectation(entry), entry.help);
  }

  void write(const Entry& entry) {
    const bool was_disabled = disabled_;
    const bool left_out = !entry.required && entry.fallback.index() == 0;
    disabled_ = disabled_ || left_out || entry.kind == Kind::blocks;
    write_enabled(entry);
    disabled_ = was_disabled;
  }

  void write_enabled(const Entry& entry) {
    const std::string key = entry.key + ":";
    switch (entry.kind) {
      case Kind::section:
        put(key, entry.required ? entry.help : "optional: " + entry.help);
        nested(*entry.nested);
        return;
      case Kind::sections: {
        put(key, fmt::format("{}: a list of blocks; {}", entry.required ? "one or more" : "optional", entry.help));
        const std::string indent = std::exchange(indent_, indent_ + "  ");
        first_ = "- ";
        list_disabled_ = disabled_;
        block(*entry.nested);
        first_.clear();
        indent_ = indent;
        return;
      }
      case Kind::component:
        if (entry.fallback.index() == 0) {
          put(key, wanted(entry));
        } else {
          component(entry);
        }
        return;
      case Kind::blocks:
        for (const std::string& name : catalogue::names(entry.category)) {
          const Registration& registration = catalogue::find(entry.category, name, "");
          put(block_key(name) + ":", registration.summary);
          nested(registration.specification());
        }
        return;
      default:
        if (entry.fallback.index() == 0) {
          put(key, wanted(entry));
        } else {
          put(key + " " + default_text(entry), remark(entry));
        }
    }
  }

  void component(const Entry& entry) {
    const std::string& name = std::get<std::string>(entry.fallback);
    const std::pair<std::string, std::string> self{entry.category, name};
    const bool within_itself = std::find(open_.begin(), open_.end(), self) != open_.end();
    const Specification specification = catalogue::find(entry.category, name, "").specification();
    if (within_itself || specification.entries().empty()) {
      put(entry.key + ": " + yaml_text(name), remark(entry));
      return;
    }
    put(entry.key + ":", entry.help);
    open_.push_back(self);
    const std::string indent = std::exchange(indent_, indent_ + "  ");
    put("type: " + yaml_text(name), expectation(entry));
    block(specification);
    indent_ = indent;
    open_.pop_back();
  }

  void nested(const Specification& specification) {
    const std::string indent = std::exchange(indent_, indent_ + "  ");
    block(specification);
    indent_ = indent;
  }

  std::vector<Line> lines_;
  std::string indent_;
  std::string first_;           ///< "- " before the first key of a list's item
  bool list_disabled_ = false;  ///< whether that list is commented out
  bool disabled_ = false;
  std::vector<std::pair<std::string, std::string>> open_;
};

}  // namespace

std::string template_of(const Specification& specification, const std::string& title) {
  Writer writer;
  writer.comment(title);
  writer.block(specification);
  return writer.text();
}

std::string template_of(const std::string& name) {
  std::string text;
  std::vector<std::string> known;
  for (const Registration* registration : catalogue::all()) {
    known.push_back(registration->name);
    if (registration->name != name) continue;
    Writer writer;
    writer.comment(fmt::format("{}: {}", registration->category, registration->summary));
    writer.type(name, registration->category);
    writer.block(registration->specification());
    text += (text.empty() ? "" : "---\n") + writer.text();
  }
  if (text.empty()) {
    throw InputError("", fmt::format("there is no component {}", in_quotes(name)), "a name that `kiln list` shows",
                     nearest(name, known));
  }
  return text;
}

}  // namespace kiln
