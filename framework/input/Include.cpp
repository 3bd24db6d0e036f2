#include "framework/input/Include.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "framework/base/Text.hpp"

namespace kiln {
namespace {

/// A file that includes two others that include two others … is cut short.
constexpr int most_files = 100;
/// Of a file's name, in a message.
constexpr std::size_t longest_shown = 1000;

void merge(YamlNode& lower, YamlNode upper) {
  if (lower.kind != YamlNode::Kind::map || upper.kind != YamlNode::Kind::map) {
    lower = std::move(upper);
    return;
  }
  const YamlNode* lower_type = lower.find("type");
  const YamlNode* upper_type = upper.find("type");
  if (lower_type != nullptr && upper_type != nullptr && lower_type->text != upper_type->text) {
    lower = std::move(upper);
    return;
  }
  lower.location = upper.location;
  for (YamlPair& pair : upper.pairs) {
    YamlNode* known = lower.find(pair.key);
    if (known != nullptr && known->kind == YamlNode::Kind::map && pair.value.kind == YamlNode::Kind::map) {
      merge(*known, std::move(pair.value));
    } else {
      lower.set(pair.key, pair.location, std::move(pair.value));
    }
  }
}

class Reader {
 public:
  Reader(InputFiles& files, Mistakes& mistakes) : files_(files), mistakes_(mistakes) {}

  /// `from`: where the file is included.
  bool read(const std::string& file, const Location& from, YamlNode& root) {
    const std::string path = files_.absolute(file);
    const bool included = !chain_.empty();
    const auto refuse = [&](std::string found) {
      mistakes_.add(from, {included ? "include" : "", std::move(found), {}, {}});
      return false;
    };
    if (std::find(paths_.begin(), paths_.end(), path) != paths_.end()) {
      return refuse(fmt::format("the file includes itself: {} -> {}", fmt::join(chain_, " -> "), file));
    }
    if (++count_ > most_files) return refuse(fmt::format("more than {} files are included", most_files - 1));
    const InputFiles::Contents& contents = files_.read(path);
    if (!contents.trouble.empty()) {
      return refuse(included ? fmt::format("{}: {}", contents.trouble, shown(file, longest_shown)) : contents.trouble);
    }
    mistakes_.begin_file(file);
    YamlNode own;
    if (!parse_yaml(contents.text, {file, 1, 1}, own, mistakes_)) return false;
    if (own.kind == YamlNode::Kind::null) return refuse_top(Location{file, 1, 1}, "the file is empty");
    if (own.kind == YamlNode::Kind::list) return refuse_top(own.location, "a list at top level");
    if (own.kind == YamlNode::Kind::scalar) {
      return refuse_top(own.location, fmt::format("a single value {} at top level", in_quotes(own.text)));
    }
    chain_.push_back(file);
    paths_.push_back(path);
    const bool complete = read_included(file, own, root);
    chain_.pop_back();
    paths_.pop_back();
    merge(root, std::move(own));
    return complete;
  }

 private:
  bool refuse_top(const Location& location, std::string found) {
    mistakes_.add(location, {{}, std::move(found), "'key: value' lines", {}});
    return false;
  }

  bool read_included(const std::string& file, YamlNode& own, YamlNode& root) {
    const YamlNode* found = own.find("include");
    if (found == nullptr) return true;
    const YamlNode include = *found;
    own.erase("include");
    const std::vector<YamlNode> names =
        include.kind == YamlNode::Kind::list ? include.items : std::vector<YamlNode>{include};
    bool complete = true;
    for (const YamlNode& name : names) {
      if (name.kind != YamlNode::Kind::scalar || name.text.empty()) {
        mistakes_.add(name.location, {"include", "no file name is given", "a file or a list of files", {}});
        complete = false;
        continue;
      }
      const std::filesystem::path path = std::filesystem::path(file).parent_path() / name.text;
      YamlNode below;
      complete = read(path.lexically_normal().string(), name.location, below) && complete;
      merge(root, std::move(below));
    }
    return complete;
  }

  InputFiles& files_;
  Mistakes& mistakes_;
  int count_ = 0;
  std::vector<std::string> chain_;
  std::vector<std::string> paths_;
};

}  // namespace

bool read_with_includes(const std::string& file, InputFiles& files, YamlNode& root, Mistakes& mistakes) {
  return Reader(files, mistakes).read(file, {file, 0, 0}, root);
}

}  // namespace kiln
