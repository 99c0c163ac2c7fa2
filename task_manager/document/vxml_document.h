#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "vm_protocol/core/result.h"
#include "vm_protocol/xml/node.h"

namespace vxml {

/// Something to say about a document. Errors make it unfit to run (error.badfetch).
struct Finding {
  enum class Severity { kError, kWarning };
  Severity severity = Severity::kError;
  std::size_t line = 0;
  std::size_t column = 0;
  std::string text;    ///< what is wrong
  std::string advice;  ///< what to do about it, "" if that is plain
};
/// "URI:LINE:COLUMN: error: text (advice)"
std::string FormatFinding(const std::string& uri, const Finding& finding);

/// A loaded VoiceXML document. Immutable; shared by the sessions' contexts that run it.
struct VxmlDocument {
  std::string uri;          ///< absolute, without fragment
  std::string base;         ///< what relative references are resolved against (xml:base or uri)
  std::string application;  ///< absolute URI of the application root, "" if it is its own root
  std::string language;
  std::string version;
  std::unique_ptr<vm::xml::Node> root;
  std::vector<const vm::xml::Node*> dialogs;                  ///< forms and menus in document order
  std::map<std::string, const vm::xml::Node*> dialogs_by_id;  ///< the first of each id
  /// Those with grammars that are active in the whole document.
  std::vector<const vm::xml::Node*> dialogs_of_document_scope;
  std::vector<Finding> passed_over;  ///< elements of foreign namespaces, which root has not

  /// The last value of each <property>, by the element it stands in.
  std::map<const vm::xml::Node*, std::map<std::string, std::string>> properties;

  /// Sets the three lists of dialogs by what is in `root`.
  void FindDialogs();
  /// What a <property> directly inside the element says, or null.
  const std::string* FindProperty(const vm::xml::Node& element, const std::string& name) const;
  /// The form or menu of that id, or null.
  const vm::xml::Node* FindDialog(const std::string& id) const;
};

/// Reads and checks a document. Errors: kSyntax, kLimit, kTooLong, kBadUtf8; the text is the first
/// finding of severity error.
vm::Result<std::shared_ptr<VxmlDocument>> LoadDocument(std::string_view bytes,
                                                       const std::string& uri,
                                                       const std::string& charset = "");

/// Everything there is to say about a document's structure (VoiceXML 2.1 with our extensions).
std::vector<Finding> CheckDocument(const VxmlDocument& document);

/// A VoiceXML element, of its namespace or of none (the original wrote none).
bool IsVoiceXml(const vm::xml::Node& node);
/// An element of SSML's namespace.
bool IsSpeechMarkup(const vm::xml::Node& node);
/// Takes elements that are of no namespace a dialogue is made of out of the tree (VoiceXML's,
/// SSML's, SRGS's, EmotionML's), the root aside, and says of each that it was passed over.
std::vector<Finding> DropForeign(vm::xml::Node& root);

}  // namespace vxml
