#pragma once

#include <memory>
#include <string>

#include "task_manager/document/vxml_document.h"
#include "task_manager/interpreter/form_items.h"

namespace vxml {

/// Where the interpreter is. A subdialog has a position of its own.
/// DialogSession sets the documents, FormInterpreter the dialog, it and ProcessPhase (for <filled>)
/// the item; the element is set by who begins to run content.
struct Position {
  std::shared_ptr<VxmlDocument> document;
  std::shared_ptr<VxmlDocument> root;  ///< the application root; `document` if that is its own
  Dialog* dialog = nullptr;            ///< null while a document is initialised
  FormItem* item = nullptr;            ///< whose handlers and properties come first
  const vm::xml::Node* element = nullptr;
  bool in_subdialog = false;

  /// The innermost of element, dialog and document.
  const vm::xml::Node& Here() const;
  /// The URI that references in the element are relative to. Handlers act as if copied into the
  /// active dialog: its document's base counts, unless an xml:base around the element says
  /// otherwise.
  std::string BaseOf(const vm::xml::Node& node) const;
  /// The document the element was written in: its origin decides what the element may do.
  const VxmlDocument& OriginOf(const vm::xml::Node& node) const;
  std::string LanguageAt(const vm::xml::Node& node) const;
  /// Throws error.noauthorization unless the element came from a file of this machine.
  void RequireLocal(const vm::xml::Node& node) const;
  /// Throws error.semantic that names the element's place.
  [[noreturn]] void ThrowSemantic(const vm::xml::Node& node, const std::string& what) const;
};

}  // namespace vxml
