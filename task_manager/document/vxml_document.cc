#include "task_manager/document/vxml_document.h"

#include <algorithm>

#include "task_manager/document/emotionml.h"
#include "task_manager/fetch/uri.h"
#include "task_manager/grammar/xml_rules.h"
#include "vm_protocol/xml/parser.h"

namespace vxml {
namespace {

constexpr std::string_view kSpace = "http://www.w3.org/2001/vxml";
constexpr std::size_t kMaxPassedOver = 100;

void DropForeign(vm::xml::Node& node, std::vector<Finding>& dropped) {
  std::erase_if(node.children, [&](const std::unique_ptr<vm::xml::Node>& child) {
    if (!child->IsElement()) return false;
    if (IsVoiceXml(*child) || IsSpeechMarkup(*child) || child->space == kEmotionMlSpace ||
        child->space == srgs::kSrgsSpace) {
      return false;
    }
    if (node.name != "metadata" && dropped.size() < kMaxPassedOver) {
      dropped.push_back({Finding::Severity::kWarning, child->line, child->column,
                         "<" + child->name + "> of the namespace '" + child->space + "'",
                         "it is passed over"});
    }
    return true;
  });
  for (const auto& child : node.children) DropForeign(*child, dropped);
}

/// Whether a form or menu has grammars that are active in the whole document.
bool ReachesDocument(const vm::xml::Node& dialog) {
  return dialog.Get("scope") == "document" ||
         std::ranges::any_of(dialog.children, [](const auto& child) {
           return child->IsElement("grammar") && child->Get("scope") == "document";
         });
}

void CollectProperties(const vm::xml::Node& node, VxmlDocument& into) {
  for (const auto& child : node.children) {
    if (!child->IsElement()) continue;
    if (child->name == "property" && child->Has("value")) {
      into.properties[&node][child->Get("name")] = child->Get("value");
    }
    CollectProperties(*child, into);
  }
}

}  // namespace

bool IsVoiceXml(const vm::xml::Node& node) { return node.space.empty() || node.space == kSpace; }
bool IsSpeechMarkup(const vm::xml::Node& node) {
  return node.space == "http://www.w3.org/2001/10/synthesis";
}

std::vector<Finding> DropForeign(vm::xml::Node& root) {
  std::vector<Finding> dropped;
  DropForeign(root, dropped);
  return dropped;
}

const std::string* VxmlDocument::FindProperty(const vm::xml::Node& element,
                                              const std::string& name) const {
  const auto of_element = properties.find(&element);
  if (of_element == properties.end()) return nullptr;
  const auto found = of_element->second.find(name);
  return found == of_element->second.end() ? nullptr : &found->second;
}

void VxmlDocument::FindDialogs() {
  for (const auto& child : root->children) {
    if (!child->IsElement("form") && !child->IsElement("menu")) continue;
    dialogs.push_back(child.get());
    dialogs_by_id.emplace(child->Get("id"), child.get());
    if (ReachesDocument(*child)) dialogs_of_document_scope.push_back(child.get());
  }
}

const vm::xml::Node* VxmlDocument::FindDialog(const std::string& id) const {
  const auto found = dialogs_by_id.find(id);
  return found == dialogs_by_id.end() ? nullptr : found->second;
}

vm::Result<std::shared_ptr<VxmlDocument>> LoadDocument(std::string_view bytes,
                                                       const std::string& uri,
                                                       const std::string& charset) {
  auto parsed = vm::xml::Parse(bytes, uri, charset);
  if (!parsed) return std::unexpected(parsed.error());
  auto document = std::make_shared<VxmlDocument>();
  document->uri = fetch::WithoutFragment(uri);
  document->root = std::move(parsed->root);
  document->passed_over = DropForeign(*document->root);
  const vm::xml::Node& root = *document->root;
  const std::string base = root.Get("xml:base");
  document->base = base.empty() ? document->uri : fetch::Resolve(document->uri, base);
  document->language = root.Get("xml:lang");
  document->version = root.Get("version");
  if (const std::string* application = root.Find("application");
      application && !application->empty()) {
    document->application = fetch::WithoutFragment(fetch::Resolve(document->base, *application));
  }
  document->FindDialogs();
  CollectProperties(root, *document);
  for (const Finding& finding : CheckDocument(*document)) {
    if (finding.severity == Finding::Severity::kError) {
      return vm::Fail(vm::Errc::kSyntax, FormatFinding(uri, finding));
    }
  }
  return document;
}

}  // namespace vxml
