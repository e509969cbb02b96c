#include "yaml/document.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include "base/input_text.h"
#include "base/text.h"
#include "base/text_place.h"
#include "yaml/parser_error.h"
#include "yaml/strictness.h"

namespace freeplay {
namespace {

constexpr std::size_t most_nodes = 1'000'000, most_anchors = 10'000;
constexpr int deepest_level = 64;

/// Ends the parsing after an error that has been reported.
struct Abandon {};

/// Builds the tree from the events of the parser. Anchors, aliases and tags are judged here; what an alias stands for
/// is counted before it is used, so that nothing is ever expanded.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(Document& document, Diagnostics& diagnostics)
      : document_(document), text_(document.text()), places_(text_), diagnostics_(diagnostics) {}

  /// False if something was left out whose absence would cause other errors.
  bool trusted() const { return trusted_; }

  /// To be called after the last document.
  void finish_text() {
    const bool directive = text_.starts_with('%') || text_.find("\n%") != std::string_view::npos;
    if (documents_ == 0 && directive) refuse({text_.find('%'), "a directive needs a document after it, '---'"});
  }

  /// Where the collection begins that was being read last.
  TextPlace innermost() const {
    if (frames_.empty()) return {};
    return {frames_.back().built.node->line, frames_.back().built.node->column};
  }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ == 1) return;
    // Without its sign the "document" is what remains after a first line of keys that stands farther right; after a
    // text it may be the rest of that text, which the parser ends too early.
    const std::size_t begin = std::min(static_cast<std::size_t>(mark.pos), text_.size());
    const std::string_view before = text_.substr(0, text_.find_last_not_of(" \t\r\n", begin - 1) + 1);
    if (!document_.root().is_map() || text_.substr(begin).starts_with("---") || before.ends_with("\n...")) {
      error(place(mark), 1, "yaml-feature", "a file holds one document only");
    } else {
      error(place(mark), 1, "yaml-syntax", "this line is indented unlike the lines it belongs to");
    }
    throw Abandon();
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    arrive(mark);
    const std::size_t begin = skip_properties(mark, anchor, "?");
    const std::size_t end = begin + null_word_length(begin);
    Node& node = end > begin ? add(Node::Kind::scalar, begin) : empty(mark);
    if (end > begin) {
      describe_scalar(node, begin, text_.substr(begin, end - begin));
      doubtful_null_ = &node;
      doubtful_mark_ = mark.pos;
    }
    finish({&node, 1, 0}, anchor);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    arrive(mark);
    const std::size_t begin = skip_properties(mark, anchor, tag);
    Node& node = add(Node::Kind::scalar, begin);
    describe_scalar(node, begin, value);
    finish({&node, 1, 0}, anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    arrive(mark);
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) {
      error(place(mark), 1, "yaml-syntax", "an alias stands inside of the value that it names");
      throw Abandon();
    }
    require_depth(found->second.height);
    if (!frames_.empty() && !frames_.back().first_alias) frames_.back().first_alias = place(mark);
    attach(found->second, place(mark));
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override {
    open(Node::Kind::list, mark, tag, anchor, style);
  }
  void OnSequenceEnd() override { close(); }

  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override {
    open(Node::Kind::map, mark, tag, anchor, style);
  }
  void OnMapEnd() override { close(); }

 private:
  /// A finished value: how many nodes it has when aliases are expanded, and how many levels of lists and maps.
  struct Built {
    Node* node;
    std::size_t nodes;
    int height;
  };

  struct Frame {
    Built built;
    YAML::anchor_t anchor;
    std::set<std::string_view> keys{};
    const Node* key = nullptr;  // of the entry in hand
    bool at_value = false;      // of a map: the key has come
    bool flow = false;          // in brackets or braces
    bool leave_out = false;     // the key in hand is wrong: its value is read and dropped
    std::optional<TextPlace> first_alias{};
  };

  // --- structure

  void open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
            YAML::EmitterStyle::value style) {
    arrive(mark);
    const std::size_t begin = skip_properties(mark, anchor, tag);
    // A pair such as [a: b] is a map within the brackets without braces of its own.
    const bool flow = style == YAML::EmitterStyle::Flow || in_flow();
    if (flow && !in_flow()) refuse_if(find_flow_fault(text_, begin, block_indent()));
    frames_.push_back({{&add(kind, begin), 1, 1}, anchor});
    frames_.back().flow = flow;
    require_depth(0);
  }

  void close() {
    const Frame frame = std::move(frames_.back());
    frames_.pop_back();
    finish(frame.built, frame.anchor);
  }

  void finish(const Built& built, YAML::anchor_t anchor) {
    if (anchor != 0 && anchors_.size() == most_anchors && !frames_.empty()) refuse_size("more than 10 000 anchors");
    if (anchor != 0) anchors_[anchor] = built;
    attach(built, {built.node->line, built.node->column});
  }

  /// Puts a value where it belongs. `at` is where it stands: for an alias not the place of its node.
  void attach(const Built& built, const TextPlace& at) {
    if (frames_.empty()) {
      document_.set_root(*built.node);
      return;
    }
    Frame& frame = frames_.back();
    frame.built.nodes += built.nodes;
    frame.built.height = std::max(frame.built.height, built.height + 1);
    if (open_nodes() > most_nodes) refuse_size("more than 1 000 000 values when aliases are expanded");
    Node& parent = *frame.built.node;
    if (parent.is_list()) {
      parent.items.push_back(built.node);
    } else if (!frame.at_value) {
      frame.leave_out = !accept_key(frame, *built.node, at);
      frame.key = built.node;
      frame.at_value = true;
    } else {
      if (!frame.leave_out) parent.entries.push_back({frame.key, built.node});
      frame.at_value = false;
    }
  }

  bool accept_key(Frame& frame, Node& key, const TextPlace& at) {
    if (key.is_null()) key.kind = Node::Kind::scalar;  // an empty key is an unknown key
    if (!key.is_scalar()) {
      error(at, 1, "wrong-type", fmt::format("a key must be a word, not {}", key.kind_name()));
      return false;
    }
    if (key.text == "<<" && !key.quoted) {
      error(at, key.length, "yaml-feature", "the merge key '<<' is not supported",
            "use a preset, or write the keys out");
      trusted_ = false;
      return false;
    }
    if (!frame.keys.insert(key.text).second) {
      error(at, key.length, "duplicate-key", fmt::format("the key '{}' is given twice", key.text));
      return false;
    }
    return true;
  }

  /// Nodes of all collections that are open; each counts what is finished inside of it.
  std::size_t open_nodes() const {
    std::size_t sum = 0;
    for (const Frame& frame : frames_) sum += frame.built.nodes;
    return sum;
  }

  void require_depth(int more_levels) {
    if (static_cast<int>(frames_.size()) + more_levels <= deepest_level) return;
    const Node& outermost = *frames_[frames_.size() > 1 ? 1 : 0].built.node;
    error({outermost.line, outermost.column}, 1, "too-large", "more than 64 levels of nesting");
    throw Abandon();
  }

  /// Reports at the aliases that are too many where the section is a plain list of them, else at the section of the
  /// file that is too large, since no single value in it is to blame.
  [[noreturn]] void refuse_size(const char* message) {
    if (frames_.size() == 2 && frames_.back().first_alias) {
      error(*frames_.back().first_alias, 1, "too-large", message);
      throw Abandon();
    }
    const Frame& top = frames_.front();
    const Node& section = top.key ? *top.key : *top.built.node;
    error({section.line, section.column}, section.length, "too-large", message);
    throw Abandon();
  }

  // --- places

  TextPlace place(const YAML::Mark& mark) { return places_.at(static_cast<std::size_t>(mark.pos)); }

  Node& add(Node::Kind kind, std::size_t begin) {
    const TextPlace at = places_.at(begin);
    return document_.add(kind, at.line, at.column);
  }

  /// An absent value, placed at its key or its dash: the parser points at whatever comes next.
  Node& empty(const YAML::Mark& mark) {
    if (frames_.empty()) return document_.add(Node::Kind::null, 1, 1);
    const Frame& frame = frames_.back();
    if (frame.at_value && frame.key) {
      Node& node = document_.add(Node::Kind::null, frame.key->line, frame.key->column);
      node.length = frame.key->length;
      return node;
    }
    std::size_t begin = std::min(static_cast<std::size_t>(mark.pos), text_.size());
    const std::size_t before = begin == 0 ? std::string_view::npos : text_.find_last_not_of(" \t\r\n", begin - 1);
    if (frame.built.node->is_list() && before != std::string_view::npos && text_[before] == '-') begin = before;
    return add(Node::Kind::null, begin);
  }

  /// The parser calls an absent value and the words `~` and `null` alike. If the next event begins where the word
  /// stands, the word was a key that follows an absent value.
  void arrive(const YAML::Mark& mark) {
    if (doubtful_null_ && doubtful_mark_ == mark.pos) {
      const Node* key = frames_.empty() ? nullptr : frames_.back().key;
      doubtful_null_->kind = Node::Kind::null;
      doubtful_null_->text.clear();
      doubtful_null_->verbatim = false;
      for (auto frame = frames_.rbegin(); !key && frame != frames_.rend(); ++frame) key = frame->key;
      if (key) {
        doubtful_null_->line = key->line;
        doubtful_null_->column = key->column;
        doubtful_null_->length = key->length;
      }
    }
    doubtful_null_ = nullptr;
  }

  std::size_t null_word_length(std::size_t begin) const {
    for (const std::string_view word : {"~", "null", "Null", "NULL"}) {
      if (text_.substr(begin, word.size()) != word) continue;
      const std::size_t end = begin + word.size();
      if (end == text_.size() || std::string_view(" \t\r\n,]}:").find(text_[end]) != std::string_view::npos) {
        return word.size();
      }
    }
    return 0;
  }

  /// Position of the value itself after its anchor and tag. Tags are refused.
  std::size_t skip_properties(const YAML::Mark& mark, YAML::anchor_t anchor, const std::string& tag) {
    std::size_t begin = std::min(static_cast<std::size_t>(mark.pos), text_.size());
    while (begin < text_.size()) {
      // Without an anchor or tag of its own, a map begins at those of its first key.
      const bool named = text_[begin] == '&' && anchor != 0, tagged = text_[begin] == '!' && tag != "?";
      if (!named && !tagged) break;
      const std::size_t end = std::min(text_.find_first_of(" \t\r\n", begin), text_.size());
      require_indent(places_.at(begin));
      if (tagged) {
        error(places_.at(begin), character_count(text_.substr(begin, end - begin)), "yaml-feature",
              "explicit tags are not supported", "remove the tag");
        trusted_ = false;
      }
      begin = skip_separation(end);
    }
    return begin;
  }

  std::size_t skip_separation(std::size_t at) const {
    while (at < text_.size()) {
      if (text_[at] == '#') {
        at = std::min(text_.find('\n', at), text_.size());
      } else if (std::string_view(" \t\r\n").find(text_[at]) != std::string_view::npos) {
        ++at;
      } else {
        break;
      }
    }
    return at;
  }

  void describe_scalar(Node& node, std::size_t begin, std::string_view value) {
    node.text = value;
    const char first = begin < text_.size() ? text_[begin] : '\0';
    if (first == '|' || first == '>') {
      node.quoted = true;
      refuse_if(find_block_scalar_fault(text_, begin, block_indent()));
      return;
    }
    // Only as far as the scalar goes: a line may hold a whole file.
    std::size_t end = begin + value.size();
    if (first == '"' || first == '\'') {
      node.quoted = true;
      refuse_if(find_quoted_fault(text_, begin, block_indent()));
      end = quoted_end(text_, begin);
      node.verbatim = end > begin + 1 && text_.substr(begin + 1, end - begin - 2) == value;
    } else {
      node.verbatim = text_.substr(begin, value.size()) == value;
    }
    end = begin + std::min(text_.substr(begin, end - begin).find_first_of("\r\n"), end - begin);
    if (node.verbatim) require_colon(begin, end);
    node.length = std::max(1, character_count(text_.substr(begin, end - begin)));
  }

  // --- strictness

  /// Blanks before the innermost block list or map, -1 at top level.
  int block_indent() const {
    for (auto frame = frames_.rbegin(); frame != frames_.rend(); ++frame) {
      if (!frame->flow) return frame->built.node->column - 1;
    }
    return -1;
  }

  bool in_flow() const { return !frames_.empty() && frames_.back().flow; }

  [[noreturn]] void refuse(const YamlFault& fault) {
    error(places_.at(fault.position), 1, "yaml-syntax", fault.message, fault.hint);
    throw Abandon();
  }
  void refuse_if(const std::optional<YamlFault>& fault) {
    if (fault) refuse(*fault);
  }

  /// The parser takes a lone word among the keys of a block map as a key without a value.
  void require_colon(std::size_t begin, std::size_t end) {
    if (frames_.empty() || !frames_.back().built.node->is_map() || frames_.back().at_value || in_flow()) return;
    const std::size_t next = text_.find_first_not_of(" \t", end);
    if (next != std::string_view::npos && text_[next] == ':') return;
    const std::size_t line_begin = begin == 0 ? 0 : text_.find_last_of('\n', begin - 1) + 1;
    const bool explicit_key = text_.substr(line_begin, begin - line_begin).find('?') != std::string_view::npos;
    if (!explicit_key) refuse({begin, "this is not a key: a ':' is missing after it"});
  }

  /// An anchor must be indented like the value that it names.
  void require_indent(const TextPlace& property) {
    if (frames_.empty() || in_flow() || !frames_.back().at_value) return;
    const Node& key = *frames_.back().key;
    if (property.line > key.line && property.column <= frames_.back().built.node->column) {
      error(property, 1, "yaml-syntax", "an anchor must be indented more than the key before it");
      throw Abandon();
    }
  }

  void error(const TextPlace& at, int length, const char* id, std::string message, std::string hint = {}) {
    diagnostics_.error({document_.file_name(), at.line, at.column}, length, id, std::move(message), {},
                       std::move(hint));
  }

  Document& document_;
  std::string_view text_;
  TextPlaces places_;
  Diagnostics& diagnostics_;
  std::vector<Frame> frames_;
  std::map<YAML::anchor_t, Built> anchors_;
  Node* doubtful_null_ = nullptr;
  int doubtful_mark_ = 0;
  int documents_ = 0;
  bool trusted_ = true;
};

std::optional<Document> refuse(Diagnostics& diagnostics, const std::string& file, const char* id, std::string message) {
  diagnostics.error({file, 1, 1}, 1, id, std::move(message));
  return std::nullopt;
}

}  // namespace

std::optional<Document> parse_yaml(std::string text, const std::string& file_name, Diagnostics& diagnostics) {
  if (text.size() > largest_input) return refuse(diagnostics, file_name, "too-large", "the file is larger than 16 MiB");
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  end_lines_by_line_feeds(text);  // the parser library would not
  diagnostics.add_source(file_name, text);
  if (const auto fault = find_bad_character(text)) {
    const TextPlace at = TextPlaces(text).at(fault->position);
    diagnostics.error({file_name, at.line, at.column}, 1, "yaml-syntax", fault->message, {}, fault->hint);
    return std::nullopt;
  }
  if (const auto flood = find_flood(text)) {
    const TextPlace at = TextPlaces(text).at(flood->position);
    diagnostics.error({file_name, at.line, at.column}, 1, "too-large", flood->message);
    return std::nullopt;
  }
  Document document(file_name, std::move(text));
  TreeBuilder builder(document, diagnostics);
  try {
    std::istringstream stream(without_tabs_in_empty_lines(document.text()));
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
    builder.finish_text();
  } catch (const Abandon&) {
    return std::nullopt;
  } catch (const YAML::Exception& error) {
    report_parser_error(error, document, builder.innermost(), diagnostics);
    return std::nullopt;
  }
  if (!builder.trusted()) return std::nullopt;
  if (const auto fault = find_directive_fault(document.text(), document.root().is_map())) {
    const TextPlace at = TextPlaces(document.text()).at(fault->position);
    diagnostics.error({file_name, at.line, at.column}, 1, "yaml-syntax", fault->message, {}, fault->hint);
    return std::nullopt;
  }
  return document;
}

}  // namespace freeplay
