#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace vm::xml {

struct Attribute {
  std::string name;   ///< as written, with its prefix
  std::string space;  ///< namespace URI, "" without one
  std::string value;
};

/// An element or a run of text in a parsed document. Owned by its parent; the tree is read-only
/// once parsed. Places are 1-based lines and byte columns in the entity read.
struct Node {
  enum class Kind { kElement, kText, kComment, kInstruction };
  Kind kind = Kind::kElement;
  std::string name;  ///< local name; an instruction's target
  std::string prefix;
  std::string space;  ///< namespace URI, "" without one
  std::string text;   ///< of text, comments and instructions
  bool cdata = false;
  std::size_t line = 0;
  std::size_t column = 0;
  Node* parent = nullptr;
  std::vector<Attribute> attributes;
  std::vector<std::unique_ptr<Node>> children;

  bool IsElement() const { return kind == Kind::kElement; }
  bool IsElement(std::string_view wanted) const { return IsElement() && name == wanted; }
  bool IsText() const { return kind == Kind::kText; }
  /// The attribute's value, or null. `wanted` is the name as written ("xml:lang").
  const std::string* Find(std::string_view wanted) const;
  bool Has(std::string_view wanted) const { return Find(wanted) != nullptr; }
  /// The attribute's value, or `otherwise`.
  std::string Get(std::string_view wanted, std::string_view otherwise = "") const;
  /// The nearest ancestor's (or its own) value of an inherited attribute such as xml:lang.
  std::string Inherited(std::string_view wanted) const;
  /// All text below, joined.
  std::string Text() const;
  const Node* FirstElement(std::string_view wanted) const;
  Node& Add(std::unique_ptr<Node> child);
};

/// Blanks at both ends removed, and those inside made single.
std::string Collapse(std::string_view text);
std::string_view Trim(std::string_view text);
bool IsBlank(std::string_view text);
std::string Escape(std::string_view text);
/// The element as XML text on its own.
std::string Write(const Node& node);

/// A copy without its parent.
std::unique_ptr<Node> Clone(const Node& node);

}  // namespace vm::xml
