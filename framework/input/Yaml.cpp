#include "framework/input/Yaml.hpp"

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "framework/base/Text.hpp"
#include "framework/input/TextCheck.hpp"

namespace kiln {

YamlNode YamlNode::scalar(std::string text, Location location) {
  YamlNode node;
  node.kind = Kind::scalar;
  node.text = std::move(text);
  node.location = std::move(location);
  return node;
}

YamlNode YamlNode::map(Location location) {
  YamlNode node;
  node.kind = Kind::map;
  node.location = std::move(location);
  return node;
}

const YamlNode* YamlNode::find(const std::string& key) const {
  for (const YamlPair& pair : pairs) {
    if (pair.key == key) return &pair.value;
  }
  return nullptr;
}

YamlNode* YamlNode::find(const std::string& key) {
  return const_cast<YamlNode*>(static_cast<const YamlNode&>(*this).find(key));
}

YamlNode& YamlNode::set(const std::string& key, const Location& key_location, YamlNode value) {
  const auto known = std::find_if(pairs.begin(), pairs.end(), [&](const YamlPair& pair) { return pair.key == key; });
  if (known == pairs.end()) return pairs.emplace_back(YamlPair{key, key_location, std::move(value)}).value;
  known->location = key_location;
  known->value = std::move(value);
  return known->value;
}

void YamlNode::erase(const std::string& key) {
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), [&](const YamlPair& pair) { return pair.key == key; }),
              pairs.end());
}

namespace {

constexpr std::size_t deepest = 64;
constexpr std::size_t most_aliased = 100000;
constexpr std::size_t most_values = 200000;
/// Keys are looked up one after the other.
constexpr std::size_t most_keys = 5000;

/// What ends the parsing of a document.
struct Refusal {
  YAML::Mark mark;
  std::string found;
  std::string expected;
};

std::size_t size_of(const YamlNode& node) {
  std::size_t size = 1;
  for (const YamlNode& item : node.items) size += size_of(item);
  for (const YamlPair& pair : node.pairs) size += size_of(pair.value);
  return size;
}

/// Builds the tree from the parser's events rather than from its nodes: these keep the place of an alias, and a cyclic
/// or exploding alias is refused before it is built.
class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& text, const Location& origin, Mistakes& mistakes)
      : text_(text), origin_(origin), mistakes_(mistakes) {}

  YamlNode take_root() { return std::move(root_); }

  Location location(const YAML::Mark& mark) const {
    return origin_.line == 0 ? origin_ : Location{origin_.file, mark.line + 1, mark.column + 1};
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (!started_) {
      started_ = true;
      return;
    }
    if (text_.compare(static_cast<std::size_t>(mark.pos), 3, "---") == 0) {
      throw Refusal{mark, "a second document starts here", "one document in a file"};
    }
    throw Refusal{mark, "this line is indented less than the first one", "the keys of a block in the same column"};
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    YamlNode node;
    node.location = location(mark);
    add(std::move(node), anchor, "");
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto anchored = anchors_.find(anchor);
    if (anchored == anchors_.end()) throw Refusal{mark, "this alias stands inside the value it repeats", {}};
    aliased_ += size_of(anchored->second);
    if (aliased_ > most_aliased) {
      throw Refusal{mark, fmt::format("aliases repeat more than {} values", most_aliased), {}};
    }
    YamlNode node = anchored->second;
    node.location = location(mark);
    add(std::move(node), 0, "?");
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    check_tag(mark, tag);
    check_quotes(mark, tag);
    check_characters(mark, value);
    count_value(mark);
    if (too_many_keys()) throw Refusal{mark, fmt::format("more than {} keys in one block", most_keys), {}};
    add(YamlNode::scalar(value, location(mark)), anchor, tag);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    YamlNode node;
    node.kind = YamlNode::Kind::list;
    open(std::move(node), mark, tag, anchor);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open(YamlNode::map({}), mark, tag, anchor);
  }

  void OnMapEnd() override {
    Frame& frame = frames_.back();
    for (YamlNode& merged : frame.merges) merge(merged, frame.node);
    close();
  }

 private:
  struct Frame {
    YamlNode node;
    YAML::anchor_t anchor;
    std::vector<YamlNode> merges;
    bool has_key = false;
    bool usable_key = false;
    bool merge_key = false;
    std::string key;
    Location key_location;
  };

  void check_tag(const YAML::Mark& mark, const std::string& tag) const {
    static const std::string standard = "tag:yaml.org,2002:";
    if (tag.empty() || tag == "?" || tag == "!") return;
    for (const char* name : {"str", "int", "float", "bool", "null", "seq", "map"}) {
      if (tag == standard + name) return;
    }
    throw Refusal{mark, fmt::format("the tag {}", in_quotes(tag)), "a value without a tag"};
  }

  /// The parser takes the end of the file for a missing closing quote.
  void check_quotes(const YAML::Mark& mark, const std::string& tag) const {
    const auto begin = static_cast<std::size_t>(mark.pos);
    if (tag == "?" || begin >= text_.size()) return;
    const char quote = text_[begin];
    if (quote != '\'' && quote != '"') return;
    for (std::size_t i = begin + 1; i < text_.size(); ++i) {
      if (quote == '"' && text_[i] == '\\') {
        ++i;
      } else if (text_[i] == quote) {
        if (quote == '"' || i + 1 >= text_.size() || text_[i + 1] != quote) return;
        ++i;
      }
    }
    throw Refusal{mark, "the quotes that open here are not closed", {}};
  }

  /// Escapes can write what check_text() keeps out.
  static void check_characters(const YAML::Mark& mark, const std::string& value) {
    if (value.find('\0') == std::string::npos) return;
    throw Refusal{mark, fmt::format("the text {} holds the character NUL", in_quotes(value)), "a text without it"};
  }

  void count_value(const YAML::Mark& mark) {
    if (++values_ > most_values) throw Refusal{mark, fmt::format("more than {} values", most_values), {}};
  }

  void open(YamlNode node, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor) {
    check_tag(mark, tag);
    count_value(mark);
    if (frames_.size() == deepest) throw Refusal{mark, fmt::format("more than {} levels of blocks", deepest), {}};
    node.location = location(mark);
    Frame frame;
    frame.node = std::move(node);
    frame.anchor = anchor;
    frames_.push_back(std::move(frame));
  }

  bool too_many_keys() const { return !frames_.empty() && frames_.back().node.pairs.size() > most_keys; }

  void close() {
    Frame frame = std::move(frames_.back());
    frames_.pop_back();
    add(std::move(frame.node), frame.anchor, "");
  }

  void add(YamlNode node, YAML::anchor_t anchor, const std::string& tag) {
    if (anchor != 0) anchors_[anchor] = node;
    if (frames_.empty()) {
      root_ = std::move(node);
    } else if (frames_.back().node.kind == YamlNode::Kind::list) {
      frames_.back().node.items.push_back(std::move(node));
    } else if (!frames_.back().has_key) {
      add_key(std::move(node), tag);
    } else {
      add_value(std::move(node));
    }
  }

  void add_key(YamlNode node, const std::string& tag) {
    Frame& frame = frames_.back();
    frame.has_key = true;
    frame.usable_key = node.kind == YamlNode::Kind::scalar;
    frame.merge_key = frame.usable_key && tag == "?" && node.text == "<<";
    frame.key = std::move(node.text);
    frame.key_location = std::move(node.location);
    if (!frame.usable_key) mistakes_.add(frame.key_location, {path(), "a key that is no text", "'key: value'", {}});
  }

  void add_value(YamlNode node) {
    Frame& frame = frames_.back();
    frame.has_key = false;
    if (!frame.usable_key) return;
    if (frame.merge_key) {
      frame.merges.push_back(std::move(node));
      return;
    }
    for (const YamlPair& pair : frame.node.pairs) {
      if (pair.key != frame.key) continue;
      mistakes_.add(frame.key_location, {path(), "duplicate key", first_place(pair.location), {}});
      return;
    }
    if (node.kind == YamlNode::Kind::map || node.kind == YamlNode::Kind::null) node.location = frame.key_location;
    frame.node.pairs.push_back({frame.key, frame.key_location, std::move(node)});
  }

  static std::string first_place(const Location& first) {
    return first.line == 0 ? "each key once"
                           : fmt::format("each key once; it is given at {} already", to_string(first));
  }

  /// Keys of the block itself win over merged ones, earlier merged ones over later.
  void merge(YamlNode& merged, YamlNode& into) {
    if (merged.kind == YamlNode::Kind::list) {
      for (YamlNode& item : merged.items) merge(item, into);
    } else if (merged.kind == YamlNode::Kind::map) {
      for (YamlPair& pair : merged.pairs) {
        if (into.pairs.size() > most_keys) {
          return mistakes_.add(merged.location,
                               {path(), fmt::format("more than {} keys in one block", most_keys), {}, {}});
        }
        if (into.find(pair.key) == nullptr) into.pairs.push_back(std::move(pair));
      }
    } else {
      mistakes_.add(merged.location, {path(), "'<<' without a block", "an alias of a block, or a list of such", {}});
    }
  }

  /// Path of the value that is being built.
  std::string path() const {
    std::string path;
    for (const Frame& frame : frames_) {
      const bool in_list = frame.node.kind == YamlNode::Kind::list;
      const std::string name = in_list ? std::to_string(frame.node.items.size()) : shown(frame.key);
      path += (path.empty() || name.empty() ? "" : ".") + name;
    }
    return path;
  }

  const std::string& text_;
  const Location& origin_;
  Mistakes& mistakes_;
  bool started_ = false;
  std::size_t aliased_ = 0;
  std::size_t values_ = 0;
  YamlNode root_;
  std::vector<Frame> frames_;
  std::map<YAML::anchor_t, YamlNode> anchors_;
};

/// The parser's message in words that a user without knowledge of its grammar understands.
Problem syntax_problem(const YAML::ParserException& error) {
  struct Words {
    const char* message;
    const char* found;
    const char* expected;
  };
  static const Words table[] = {
      {YAML::ErrorMsg::MAP_VALUE, "a ':' where no key may end",
       "'key: value' on a line of its own, indented like its neighbours, with a space after each ':'"},
      {YAML::ErrorMsg::MAP_KEY, "a key where none may stand", "each key on a line of its own"},
      {YAML::ErrorMsg::END_OF_SEQ_FLOW, "a list opened by '[' is not closed", "',' or ']'"},
      {YAML::ErrorMsg::END_OF_MAP_FLOW, "a block opened by '{' is not closed", "',' or '}'"},
      {YAML::ErrorMsg::END_OF_SEQ, "neither an item of the list above nor a key",
       "'- ' in the column of the other items"},
      {YAML::ErrorMsg::END_OF_MAP, "no key of the block above", "a key in the column of the other keys"},
      {YAML::ErrorMsg::EOF_IN_SCALAR, "a text in quotes is not closed", "a closing quote"},
      {YAML::ErrorMsg::FLOW_END, "a closing bracket without an opening one", ""},
      {YAML::ErrorMsg::BLOCK_ENTRY, "'-' in the middle of a value", "items of a list on lines of their own"},
      {YAML::ErrorMsg::UNKNOWN_TOKEN, "a character that no value begins with", "quotes around the value"},
      {YAML::ErrorMsg::UNKNOWN_ANCHOR, "an alias without an anchor", "an '&name' further up in the file"},
  };
  for (const Words& words : table) {
    if (error.msg == words.message) return {{}, words.found, words.expected, {}};
  }
  return {{}, fmt::format("not YAML: {}", error.msg), {}, {}};
}

}  // namespace

bool parse_yaml(std::string text, const Location& origin, YamlNode& root, Mistakes& mistakes) {
  static const std::string byte_order_mark = "\xef\xbb\xbf";
  if (text.compare(0, byte_order_mark.size(), byte_order_mark) == 0) text.erase(0, byte_order_mark.size());
  if (!check_text(text, origin, mistakes)) return false;
  TreeBuilder builder(text, origin, mistakes);
  try {
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const Refusal& refusal) {
    mistakes.add(builder.location(refusal.mark), {{}, refusal.found, refusal.expected, {}});
    return false;
  } catch (const YAML::ParserException& error) {
    mistakes.add(builder.location(error.mark), syntax_problem(error));
    return false;
  }
  root = builder.take_root();
  return true;
}

}  // namespace kiln
