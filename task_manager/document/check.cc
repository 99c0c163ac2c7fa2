#include <map>

#include "task_manager/document/emotionml.h"
#include "task_manager/document/schema.h"
#include "task_manager/document/values.h"
#include "task_manager/document/vxml_document.h"
#include "task_manager/grammar/xml_rules.h"
#include "vm_protocol/xml/parser.h"

namespace vxml {
namespace {

class Checker {
 public:
  explicit Checker(const VxmlDocument& document) : document_(document) {}

  std::vector<Finding> Run() {
    const vm::xml::Node& root = *document_.root;
    findings_ = document_.passed_over;
    if (!IsVoiceXml(root)) {
      Say(root, "<" + root.name + "> of the namespace '" + root.space + "'",
          "expected http://www.w3.org/2001/vxml");
      return std::move(findings_);
    }
    if (!root.IsElement("vxml")) {
      Say(root, "found <" + root.name + ">, expected <vxml>", "");
      return std::move(findings_);
    }
    const std::string version = root.Get("version");
    if (version.empty()) {
      Say(root, "<vxml> without version", "write version=\"2.1\"");
    } else if (version != "2.0" && version != "2.1") {
      Say(root, "version '" + version + "', expected 2.0 or 2.1", "");
    }
    Element(root);
    UniqueIds();
    return std::move(findings_);
  }

 private:
  void Say(const vm::xml::Node& at, std::string text, std::string advice,
           Finding::Severity severity = Finding::Severity::kError) {
    if (findings_.size() < 200) {
      findings_.push_back({severity, at.line, at.column, std::move(text), std::move(advice)});
    }
  }
  void Warn(const vm::xml::Node& at, std::string text, std::string advice) {
    Say(at, std::move(text), std::move(advice), Finding::Severity::kWarning);
  }

  void Element(const vm::xml::Node& node) {
    const ElementRule* rule = FindElementRule(node.name);
    if (!rule) return Speech(node);
    Attributes(node, *rule);
    for (const auto& child : node.children) {
      if (child->IsText()) {
        if (!rule->text && !vm::xml::IsBlank(child->text)) {
          Say(*child, "text in <" + node.name + ">", "put it into a <prompt>");
        }
        continue;
      }
      if (!child->IsElement()) continue;
      if (!Allows(*rule, child->name) || !IsOfItsSpace(*child)) {
        Misplaced(node, *child);
      } else if (child->name == "grammar") {
        Grammar(*child, node);
      } else if (child->space != kEmotionMlSpace) {
        Element(*child);
      }
    }
    if (node.name == "form") Form(node);
    if (node.name == "menu") Menu(node);
    if (node.name == "script") Script(node);
    if (node.name == "filled" && node.parent && node.parent->name != "form" &&
        (node.Has("mode") || node.Has("namelist"))) {
      Say(node, "<filled> in <" + node.parent->name + "> with mode or namelist",
          "they belong to the <filled> of a <form>");
    }
  }

  /// SSML has its own reader; here only what VoiceXML says of the elements in it.
  void Speech(const vm::xml::Node& node) {
    if (node.name == "audio") Audio(node);
    for (const auto& child : node.children) {
      if (child->IsElement() && IsVoiceXml(*child)) Element(*child);
    }
  }

  /// Whether the element's namespace has such an element that may stand in a dialogue.
  static bool IsOfItsSpace(const vm::xml::Node& node) {
    if (node.space == kEmotionMlSpace) return node.name == "emotion";
    if (node.space == srgs::kSrgsSpace) return node.name == "grammar";
    return !IsSpeechMarkup(node) || IsSpeechName(node.name);
  }

  void Misplaced(const vm::xml::Node& parent, const vm::xml::Node& child) {
    const bool known = FindElementRule(child.name) != nullptr;
    Say(child,
        known ? "<" + child.name + "> may not stand in <" + parent.name + ">"
              : "unknown element <" + child.name + "> in <" + parent.name + ">",
        "");
  }

  void Attributes(const vm::xml::Node& node, const ElementRule& rule) {
    for (const std::string_view word : SplitWords(rule.attributes)) {
      if (word.starts_with("!") && !node.Has(word.substr(1))) {
        Say(node, "<" + node.name + "> without " + std::string(word.substr(1)), "");
      }
    }
    for (const vm::xml::Attribute& attribute : node.attributes) {
      if (attribute.name.find(':') != std::string::npos || attribute.name == "xmlns") continue;
      if (!KnowsAttribute(rule, attribute.name)) {
        Warn(node, "<" + node.name + "> has no attribute '" + attribute.name + "'",
             "it is ignored");
      } else if (const std::string wrong = WrongValue(node.name, attribute.name, attribute.value);
                 !wrong.empty()) {
        Say(node, attribute.name + "=\"" + attribute.value + "\" in <" + node.name + ">", wrong);
      }
    }
    for (const AttributeChoice& choice : AttributeChoices()) {
      if (choice.element != node.name) continue;
      int count = 0;
      for (const std::string_view name : SplitWords(choice.names)) count += node.Has(name) ? 1 : 0;
      if (count >= choice.min && count <= choice.max) continue;
      const std::string how = choice.min == choice.max ? "exactly one" : "at most one";
      Say(node,
          "<" + node.name + "> with " + std::to_string(count) + " of the attributes " +
              std::string(choice.names),
          "give " + how);
    }
  }

  void Grammar(const vm::xml::Node& node, const vm::xml::Node& parent) {
    const bool inline_text = node.FirstElement("rule") || node.FirstElement("token") ||
                             node.FirstElement("item") || node.FirstElement("one-of") ||
                             !vm::xml::IsBlank(node.Text());
    const int sources =
        (node.Has("src") ? 1 : 0) + (node.Has("srcexpr") ? 1 : 0) + (inline_text ? 1 : 0);
    if (sources != 1) {
      Say(node, "<grammar> with " + std::to_string(sources) + " of src, srcexpr and own rules",
          "give exactly one");
    }
    if (node.Has("scope") && parent.name != "form") {
      Say(node, "<grammar scope> in <" + parent.name + ">",
          "scope belongs to grammars of a <form>");
    }
    const std::string scope = node.Get("scope", "dialog");
    if (scope != "dialog" && scope != "document") {
      Say(node, "grammar scope '" + scope + "'", "expected dialog or document");
    }
  }

  void Script(const vm::xml::Node& node) {
    const int sources = (node.Has("src") ? 1 : 0) + (node.Has("srcexpr") ? 1 : 0) +
                        (vm::xml::IsBlank(node.Text()) ? 0 : 1);
    if (sources == 1) return;
    Say(node, "<script> with " + std::to_string(sources) + " of src, srcexpr and own text",
        "give exactly one");
  }

  void Audio(const vm::xml::Node& node) {
    if (node.Has("src") != node.Has("expr")) return;
    Say(node, node.Has("src") ? "<audio> with src and expr" : "<audio> without src or expr",
        "give exactly one");
  }

  static bool IsInput(const std::string& name) {
    return name == "field" || name == "record" || name == "transfer" || name == "subdialog" ||
           name == "object";
  }

  void Form(const vm::xml::Node& form) {
    std::map<std::string, const vm::xml::Node*> names;
    for (const auto& child : form.children) {
      const std::string& kind = child->name;
      if (!child->IsElement() || (!IsInput(kind) && kind != "block" && kind != "initial")) continue;
      const std::string name = child->Get("name");
      if (name.empty()) continue;
      if (!names.emplace(name, child.get()).second) {
        Say(*child, "the form has two items named '" + name + "'", "names are unique in a form");
      }
    }
    for (const auto& child : form.children) {
      if (!child->IsElement("filled")) continue;
      const std::string namelist = child->Get("namelist");
      for (const std::string_view word : SplitWords(namelist)) {
        const auto found = names.find(std::string(word));
        if (found != names.end() && !IsInput(found->second->name)) {
          Say(*child,
              "namelist of <filled> has '" + std::string(word) + "', a <" + found->second->name +
                  ">",
              "only input items can be filled");
        }
      }
    }
  }

  void Menu(const vm::xml::Node& menu) {
    if (menu.Get("dtmf", "false") != "true") return;
    for (const auto& child : menu.children) {
      const std::string dtmf = child->IsElement("choice") ? child->Get("dtmf") : "";
      if (!dtmf.empty() && dtmf != "0" && dtmf != "*" && dtmf != "#") {
        Say(*child, "<choice dtmf=\"" + dtmf + "\"> in a menu that numbers its choices itself",
            "only 0, * and # may be given");
      }
    }
  }

  void UniqueIds() {
    std::map<std::string, const vm::xml::Node*> ids;
    for (const vm::xml::Node* dialog : document_.dialogs) {
      const std::string id = dialog->Get("id");
      if (!id.empty() && !ids.emplace(id, dialog).second) {
        Say(*dialog, "two dialogs with the id '" + id + "'", "ids are unique in a document");
      }
    }
    if (document_.dialogs.empty()) {
      Warn(*document_.root, "a document without <form> or <menu>", "it ends at once");
    }
  }

  const VxmlDocument& document_;
  std::vector<Finding> findings_;
};

}  // namespace

std::string FormatFinding(const std::string& uri, const Finding& finding) {
  std::string text =
      uri + ":" + std::to_string(finding.line) + ":" + std::to_string(finding.column) + ": " +
      (finding.severity == Finding::Severity::kError ? "error: " : "warning: ") + finding.text;
  if (!finding.advice.empty()) text += " (" + finding.advice + ")";
  return text;
}

std::vector<Finding> CheckDocument(const VxmlDocument& document) { return Checker(document).Run(); }

}  // namespace vxml
