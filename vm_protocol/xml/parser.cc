#include "vm_protocol/xml/parser.h"

#include "vm_protocol/core/charset.h"
#include "vm_protocol/core/lower_case.h"

// Debian builds the library so; the header shows the entity limits only then.
#define XML_DTD 1
#include <expat.h>

#include <algorithm>
#include <map>

namespace vm::xml {
namespace {

constexpr std::string_view kXmlSpace = "http://www.w3.org/XML/1998/namespace";

bool IsExpatCharset(const std::string& charset) {
  static const char* const kOwn[] = {"",         "utf-8",      "utf8",   "utf-16",
                                     "utf-16le", "iso-8859-1", "latin1", "us-ascii"};
  return std::find(std::begin(kOwn), std::end(kOwn), charset) != std::end(kOwn);
}

/// encoding="..." of the XML declaration, which is ASCII in every encoding handled by iconv here.
std::string DeclaredCharset(std::string_view bytes) {
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);
  if (!bytes.starts_with("<?xml")) return "";
  const std::string_view head = bytes.substr(0, std::min(bytes.find("?>"), std::size_t{200}));
  const std::size_t at = head.find("encoding");
  if (at == std::string_view::npos) return "";
  const std::size_t open = head.find_first_of("\"'", at);
  if (open == std::string_view::npos) return "";
  const std::size_t close = head.find(head[open], open + 1);
  if (close == std::string_view::npos) return "";
  return LowerCase(head.substr(open + 1, close - open - 1));
}

class Builder {
 public:
  Builder(XML_Parser parser, std::string name, const Limits& limits)
      : parser_(parser), name_(std::move(name)), limits_(limits) {
    XML_SetUserData(parser, this);
    XML_SetElementHandler(
        parser, [](void* self, const char* n, const char** a) { To(self).Start(n, a); },
        [](void* self, const char*) { To(self).End(); });
    XML_SetCharacterDataHandler(parser, [](void* self, const char* text, int size) {
      To(self).Text({text, static_cast<std::size_t>(size)});
    });
    XML_SetCdataSectionHandler(
        parser, [](void* self) { To(self).in_cdata_ = true; },
        [](void* self) { To(self).in_cdata_ = false; });
    XML_SetProcessingInstructionHandler(parser,
                                        [](void* self, const char* target, const char* data) {
                                          To(self).Other(Node::Kind::kInstruction, target, data);
                                        });
    XML_SetCommentHandler(parser, [](void* self, const char* data) {
      To(self).Other(Node::Kind::kComment, "", data);
    });
    XML_SetBillionLaughsAttackProtectionMaximumAmplification(
        parser, static_cast<float>(limits.entity_growth));
    XML_SetBillionLaughsAttackProtectionActivationThreshold(parser, 64 * 1024);
  }

  const vm::Error& error() const { return error_; }
  bool failed() const { return failed_; }
  void FailAt(vm::Errc code, const std::string& what) {
    if (failed_) return;
    failed_ = true;
    const std::size_t line = XML_GetCurrentLineNumber(parser_);
    const std::size_t column = XML_GetCurrentColumnNumber(parser_) + 1;
    error_ = {code, name_ + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + what,
              0};
    XML_StopParser(parser_, XML_FALSE);
  }
  XmlDocument& document() { return document_; }

 private:
  static Builder& To(void* self) { return *static_cast<Builder*>(self); }

  std::unique_ptr<Node> Make(Node::Kind kind) {
    auto node = std::make_unique<Node>();
    node->kind = kind;
    node->line = XML_GetCurrentLineNumber(parser_);
    node->column = XML_GetCurrentColumnNumber(parser_) + 1;
    CountNode();
    return node;
  }

  /// Elements, attributes, runs of text, comments and instructions. False: there are too many.
  bool CountNode() {
    if (++nodes_ <= limits_.nodes) return true;
    FailAt(vm::Errc::kLimit, "more than " + std::to_string(limits_.nodes) + " nodes");
    return false;
  }

  void Declare(const std::string& prefix, const std::string& space) {
    spaces_[prefix].push_back(space);
    declared_.back().push_back(prefix);
  }

  void Start(const char* name, const char** attributes) {
    if (failed_) return;
    if (++depth_ > limits_.depth) {
      return FailAt(vm::Errc::kLimit,
                    "elements nested deeper than " + std::to_string(limits_.depth));
    }
    auto node = Make(Node::Kind::kElement);
    for (; *attributes; attributes += 2) {
      const std::string_view value = attributes[1];
      if (value.size() > limits_.text_bytes) return TooLong("attribute value");
      if (!CountNode()) return;
      node->attributes.push_back({attributes[0], "", std::string(value)});
    }
    declared_.emplace_back();
    for (const Attribute& a : node->attributes) {
      if (a.name == "xmlns") Declare("", a.value);
      if (a.name.starts_with("xmlns:")) Declare(a.name.substr(6), a.value);
    }
    SplitName(name, *node);
    for (Attribute& a : node->attributes) {
      const std::size_t colon = a.name.find(':');
      if (colon != std::string::npos) a.space = SpaceOf(a.name.substr(0, colon));
    }
    Node* raw = node.get();
    if (open_.empty()) {
      document_.root = std::move(node);
    } else {
      open_.back()->Add(std::move(node));
    }
    open_.push_back(raw);
  }

  void SplitName(std::string_view name, Node& node) {
    const std::size_t colon = name.find(':');
    if (colon == std::string_view::npos) {
      node.name = name;
    } else {
      node.prefix = name.substr(0, colon);
      node.name = name.substr(colon + 1);
    }
    node.space = SpaceOf(node.prefix);
  }

  std::string SpaceOf(const std::string& prefix) const {
    if (prefix == "xml") return std::string(kXmlSpace);
    const auto found = spaces_.find(prefix);
    return found == spaces_.end() || found->second.empty() ? "" : found->second.back();
  }

  void End() {
    if (failed_ || open_.empty()) return;
    --depth_;
    for (const std::string& prefix : declared_.back()) spaces_[prefix].pop_back();
    declared_.pop_back();
    open_.pop_back();
  }

  void Text(std::string_view text) {
    if (failed_ || open_.empty()) return;
    auto& siblings = open_.back()->children;
    if (siblings.empty() || !siblings.back()->IsText() || siblings.back()->cdata != in_cdata_) {
      auto node = Make(Node::Kind::kText);
      node->cdata = in_cdata_;
      open_.back()->Add(std::move(node));
    }
    std::string& run = siblings.back()->text;
    if (run.size() + text.size() > limits_.text_bytes) return TooLong("run of text");
    run += text;
  }

  void Other(Node::Kind kind, std::string_view target, std::string_view data) {
    if (failed_) return;
    auto node = Make(kind);
    node->name = target;
    node->text = data;
    if (!open_.empty()) {
      open_.back()->Add(std::move(node));
    } else {
      (document_.root ? document_.epilog : document_.prolog).push_back(std::move(node));
    }
  }

  void TooLong(const std::string& what) {
    FailAt(vm::Errc::kTooLong, what + " over " + std::to_string(limits_.text_bytes) + " bytes");
  }

  XML_Parser parser_;
  std::string name_;
  Limits limits_;
  XmlDocument document_;
  std::vector<Node*> open_;
  std::map<std::string, std::vector<std::string>> spaces_;  ///< by prefix, the innermost last
  std::vector<std::vector<std::string>> declared_;          ///< prefixes, by open element
  std::size_t depth_ = 0;
  std::size_t nodes_ = 0;
  bool in_cdata_ = false;
  bool failed_ = false;
  vm::Error error_;
};

}  // namespace

vm::Result<XmlDocument> Parse(std::string_view bytes, const std::string& name,
                              const std::string& charset, const Limits& limits) {
  if (bytes.size() > limits.document_bytes) {
    return vm::Fail(vm::Errc::kTooLong, name + ": document of " + std::to_string(bytes.size()) +
                                            " bytes, at most " +
                                            std::to_string(limits.document_bytes) + " are read");
  }
  std::string wanted = LowerCase(charset);
  const std::string declared = DeclaredCharset(bytes);
  if (wanted.empty()) wanted = declared;
  std::string converted;
  const char* override_charset = charset.empty() ? nullptr : wanted.c_str();
  if (!IsExpatCharset(wanted)) {
    auto utf8 = vm::DecodeCharset(bytes, wanted);
    if (!utf8) return vm::Fail(utf8.error().code, name + ":1:1: " + utf8.error().text);
    converted = std::move(*utf8);
    bytes = converted;
    override_charset = "UTF-8";
  } else if (override_charset && wanted == "utf8") {
    override_charset = "UTF-8";
  }
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser(
      XML_ParserCreate(override_charset), &XML_ParserFree);
  Builder builder(parser.get(), name, limits);
  // In pieces, so that the limits stop a hostile document before all of it is held.
  constexpr std::size_t kPiece = std::size_t{256} * 1024;
  for (std::size_t at = 0;;) {
    const std::size_t size = std::min(kPiece, bytes.size() - at);
    const bool last = at + size == bytes.size();
    const auto status =
        XML_Parse(parser.get(), bytes.data() + at, static_cast<int>(size), last ? 1 : 0);
    if (builder.failed()) return std::unexpected(builder.error());
    if (status != XML_STATUS_OK) {
      builder.FailAt(vm::Errc::kSyntax, XML_ErrorString(XML_GetErrorCode(parser.get())));
      return std::unexpected(builder.error());
    }
    if (last) break;
    at += size;
  }
  XmlDocument document = std::move(builder.document());
  document.encoding = wanted.empty() ? "utf-8" : wanted;
  return document;
}

}  // namespace vm::xml
