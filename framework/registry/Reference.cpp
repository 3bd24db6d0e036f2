#include "framework/registry/Reference.hpp"

#include <fmt/format.h>

#include <cctype>

#include "framework/registry/EntryText.hpp"
#include "framework/registry/Registry.hpp"

namespace kiln {
namespace {

using Kind = Entry::Kind;

constexpr const char* origin =
    "<!-- Written by ./dev reference from the specifications in the sources; changes belong there. -->\n\n";

std::string page_name(const std::string& name) { return block_key(name) + ".md"; }

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// As a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    // A formula's _ and * are no emphasis, and <name> is no tag.
    if (c == '<') {
      result += "&lt;";
    } else {
      result += c;
    }
  }
  return result;
}

std::string code(const std::string& text) { return text.empty() ? "" : "`" + text + "`"; }

std::string values_cell(const Entry& entry) {
  if (entry.kind == Kind::component || entry.kind == Kind::components || entry.kind == Kind::blocks) {
    return fmt::format("[{}]({})", entry.category, page_name(entry.category));
  }
  std::string text;
  for (const std::string& value : values_column(entry)) {
    text += (text.empty() ? "" : ", ") + (entry.kind == Kind::choice ? code(value) : cell(value));
  }
  return text;
}

void add_rows(const Specification& specification, const std::string& prefix, std::string& text) {
  for (const auto& entry : specification.entries()) {
    const bool real = entry->kind == Kind::real || entry->kind == Kind::reals;
    const bool blocks = entry->kind == Kind::blocks;
    const std::string name = blocks ? "*name*" : code(prefix + entry->key);
    const bool has_default = entry->fallback.index() != 0;
    text += fmt::format("| {} | {} | {} | {} | {} | {} |\n", blocks && !prefix.empty() ? code(prefix) + name : name,
                        type_text(*entry), real ? entry->unit : "",
                        has_default ? code(default_column(*entry)) : default_column(*entry), values_cell(*entry),
                        cell(entry->help));
    if (entry->nested) {
      const bool list = entry->kind == Kind::sections;
      add_rows(*entry->nested, prefix + entry->key + (list ? "[]." : "."), text);
    }
  }
}

std::string keys_table(const Specification& specification) {
  if (specification.entries().empty()) return "No keys.\n";
  std::string text = "| key | type | unit | default | values | |\n| --- | --- | --- | --- | --- | --- |\n";
  add_rows(specification, "", text);
  return text;
}

std::string category_page(const std::string& category, const std::vector<const Registration*>& members) {
  std::string text = fmt::format("{}# {}\n", origin, capitalised(category));
  for (const Registration* member : members) {
    text += fmt::format("\n## {}\n\n{}.\n\n{}", member->name, cell(capitalised(member->summary)),
                        keys_table(member->specification()));
  }
  return text;
}

}  // namespace

std::map<std::string, std::string> reference_pages(const std::vector<InputKind>& kinds) {
  std::map<std::string, std::string> pages;
  std::string index = std::string(origin) +
                      "# Reference\n\nEvery key of the files Kiln reads. `kiln describe NAME` shows the same, "
                      "`kiln template NAME` a block to start from.\n\n";
  for (const InputKind& kind : kinds) {
    index += fmt::format("- [{}]({})\n", kind.title, page_name(kind.name));
    pages[page_name(kind.name)] =
        fmt::format("{}# {}\n\nA dot stands for a level of blocks, `[]` for each item of a list.\n\n{}", origin,
                    capitalised(kind.title), keys_table(kind.specification));
  }
  std::map<std::string, std::vector<const Registration*>> categories;
  for (const Registration* registration : catalogue::all()) categories[registration->category].push_back(registration);
  index += "\n| component | names |\n| --- | --- |\n";
  for (const auto& [category, members] : categories) {
    std::string names;
    for (const Registration* member : members) names += (names.empty() ? "" : ", ") + code(member->name);
    index += fmt::format("| [{}]({}) | {} |\n", category, page_name(category), names);
    pages[page_name(category)] = category_page(category, members);
  }
  pages["index.md"] = index;
  return pages;
}

}  // namespace kiln
