#include "task_manager/document/emotionml.h"

#include <algorithm>
#include <map>
#include <set>

#include "task_manager/document/emotion_vocabularies.h"
#include "task_manager/document/emotionml_values.h"
#include "task_manager/document/schema.h"

namespace vxml {
namespace {

constexpr std::string_view kVocabularies = "http://www.w3.org/TR/emotion-voc/xml";

constexpr std::string_view kVocabularySets =
    "category-set dimension-set appraisal-set action-tendency-set";
constexpr std::string_view kDescriptions = "category dimension appraisal action-tendency";

class EmotionChecker {
 public:
  explicit EmotionChecker(const vm::xml::Node& root) : root_(root) {}

  std::vector<Finding> Run() {
    if (root_.name == "emotion") {
      Say(root_, "<emotion> is no document by itself",
          "put it into <emotionml> (EmotionML 1.0 section 2.1.1)");
      Emotion(root_);
    } else {
      Root();
    }
    return std::move(findings_);
  }

 private:
  void Say(const vm::xml::Node& at, std::string text, std::string advice = "",
           Finding::Severity severity = Finding::Severity::kError) {
    findings_.push_back({severity, at.line, at.column, std::move(text), std::move(advice)});
  }

  void Attributes(const vm::xml::Node& node, std::string_view known, std::string_view required) {
    for (const vm::xml::Attribute& attribute : node.attributes) {
      if (attribute.name.starts_with("xml") || !attribute.space.empty()) continue;
      if (attribute.name.find(':') == std::string::npos && !HasWord(known, attribute.name)) {
        Say(node, "<" + node.name + "> has no attribute '" + attribute.name + "'");
      }
    }
    for (const std::string_view name : SplitWords(required)) {
      if (!node.Has(name)) Say(node, "<" + node.name + "> without " + std::string(name));
    }
    const std::string* id = node.Find("id");
    if (!id) return;
    if (!IsId(*id)) Say(node, "the id '" + *id + "'", "expected a name without blanks or colons");
    if (!ids_.insert(*id).second) Say(node, "the id '" + *id + "' is given twice");
  }

  /// What may stand in an element: its own elements in that order, `info` first, and text or not.
  /// Elements of other namespaces have a place in <info> alone.
  void Content(const vm::xml::Node& node, std::string_view elements, bool text) {
    bool first = true;
    for (const auto& child : node.children) {
      if (child->IsText() && !text && !vm::xml::IsBlank(child->text)) {
        Say(*child, "text in <" + node.name + ">");
      }
      if (!child->IsElement()) continue;
      const bool own = child->space == kEmotionMlSpace;
      if (!own || !HasWord(elements, child->name)) {
        Say(*child, "<" + child->name + ">" +
                        (own ? "" : " of the namespace '" + child->space + "'") +
                        " may not stand in <" + node.name + ">");
      } else if (child->name == "info") {
        if (!first)
          Say(*child, "<info> behind other elements", "it is the first, and the only one");
        Info(*child);
      }
      first = false;
    }
  }
  static std::vector<const vm::xml::Node*> Own(const vm::xml::Node& node, std::string_view names) {
    std::vector<const vm::xml::Node*> found;
    for (const auto& child : node.children) {
      if (child->IsElement() && child->space == kEmotionMlSpace && HasWord(names, child->name)) {
        found.push_back(child.get());
      }
    }
    return found;
  }

  /// Text and elements of others.
  void Info(const vm::xml::Node& node) {
    Attributes(node, "id", "");
    for (const auto& child : node.children) {
      if (child->IsElement() && child->space == kEmotionMlSpace) {
        Say(*child, "<" + child->name + "> in <info>", "elements of other namespaces stand there");
      }
    }
  }

  void Root() {
    if (root_.space != kEmotionMlSpace) {
      Say(root_, "<emotionml> outside of its namespace",
          "xmlns=\"" + std::string(kEmotionMlSpace) + "\"");
      return;
    }
    Attributes(root_, std::string("version ") + std::string(kVocabularySets), "version");
    Version(root_);
    Content(root_, "info vocabulary emotion", true);
    for (const auto* vocabulary : Own(root_, "vocabulary")) Declare(*vocabulary);
    for (const auto* emotion : Own(root_, "emotion")) Emotion(*emotion);
    Sets(root_);
  }

  void Version(const vm::xml::Node& node) {
    const std::string* version = node.Find("version");
    if (version && *version != "1.0") Say(node, "version '" + *version + "', expected 1.0");
  }

  void Declare(const vm::xml::Node& node) {
    Attributes(node, "type id", "type id");
    if (!HasWord(kDescriptions, node.Get("type", "category"))) {
      Say(node, "vocabulary type '" + node.Get("type") + "'",
          "expected one of " + std::string(kDescriptions));
    }
    Content(node, "info item", false);
    std::set<std::string> names;
    for (const auto* item : Own(node, "item")) {
      Attributes(*item, "name", "name");
      Token(*item, "name");
      Content(*item, "info", false);
      if (!names.insert(item->Get("name")).second) {
        Say(*item, "the vocabulary has '" + item->Get("name") + "' twice");
      }
    }
    if (names.empty()) Say(node, "a <vocabulary> without <item>");
    own_[node.Get("id")] = {node.Get("type"), names};
  }

  void Emotion(const vm::xml::Node& node) {
    Attributes(node,
               std::string("version id start end duration time-ref-uri time-ref-anchor-point "
                           "offset-to-start expressed-through ") +
                   std::string(kVocabularySets),
               "");
    Version(node);
    Times(node);
    Sets(node);
    Content(node, "info reference " + std::string(kDescriptions), true);
    const auto described = Own(node, kDescriptions);
    std::map<std::string, std::set<std::string>> names;
    for (const auto* part : described) {
      Describe(node, *part);
      if (!names[part->name].insert(part->Get("name")).second) {
        Say(*part, "two <" + part->name + "> of the name '" + part->Get("name") + "'");
      }
    }
    for (const auto* reference : Own(node, "reference")) Reference(*reference);
    if (described.empty())
      Say(node, "an <emotion> that describes nothing", "one of " + std::string(kDescriptions));
  }

  void Times(const vm::xml::Node& node) {
    Uri(node, "time-ref-uri");
    if (const std::string* through = node.Find("expressed-through")) {
      const auto words = SplitWords(*through);
      if (words.empty() || !std::ranges::all_of(words, IsToken)) {
        Say(node, "expressed-through '" + *through + "'", "expected names with blanks between");
      }
    }
    for (const char* name : {"start", "end", "duration"}) {
      const std::string* value = node.Find(name);
      if (value && !IsWhole(*value, false)) {
        Say(node, std::string(name) + " '" + *value + "'", "expected milliseconds, 0 or more");
      }
    }
    const std::string* offset = node.Find("offset-to-start");
    if (offset && !IsWhole(*offset, true))
      Say(node, "offset-to-start '" + *offset + "'", "expected milliseconds");
    const std::string anchor = node.Get("time-ref-anchor-point", "start");
    if (anchor != "start" && anchor != "end") {
      Say(node, "time-ref-anchor-point '" + anchor + "'", "expected start or end");
    }
    const auto start = Number(node.Get("start"));
    const auto end = Number(node.Get("end"));
    if (start && end && *end < *start) Say(node, "the end is before the start");
  }

  /// The declared set of a type: on the emotion, or on the root.
  std::string SetOf(const vm::xml::Node& emotion, const std::string& type) const {
    const std::string name = type + "-set";
    return emotion.Get(name, root_.Get(name));
  }

  void Sets(const vm::xml::Node& node) {
    for (const std::string_view type : SplitWords(kDescriptions)) {
      const std::string* uri = node.Find(std::string(type) + "-set");
      if (!uri) continue;
      Uri(node, (std::string(type) + "-set").c_str());
      const std::size_t hash = uri->find('#');
      if (hash == std::string::npos || hash + 1 == uri->size()) {
        Say(node, std::string(type) + "-set '" + *uri + "' names no vocabulary", "URI#id");
        continue;
      }
      const std::string id = uri->substr(hash + 1);
      std::string found;
      if (hash == 0) {
        const auto own = own_.find(id);
        if (own == own_.end()) {
          Say(node, "there is no vocabulary '" + id + "' in this document");
          continue;
        }
        found = own->second.first;
      } else if (uri->starts_with(kVocabularies)) {
        const EmotionVocabulary* known = FindEmotionVocabulary(id);
        if (!known) {
          Say(node, "there is no vocabulary '" + id + "' in " + std::string(kVocabularies));
          continue;
        }
        found = known->type;
      } else {
        Say(node, "'" + *uri + "' is not looked into", "", Finding::Severity::kWarning);
        continue;
      }
      if (found != type) {
        Say(node, std::string(type) + "-set names '" + id + "', a vocabulary of type " + found);
      }
    }
  }

  void Describe(const vm::xml::Node& emotion, const vm::xml::Node& node) {
    Attributes(node, "name value confidence", "name");
    Token(node, "name");
    const std::string set = SetOf(emotion, node.name);
    if (set.empty()) {
      Say(node, "<" + node.name + "> without a " + node.name + "-set",
          "declare it on <emotion> or <emotionml>");
    } else {
      Name(node, set);
    }
    for (const char* name : {"value", "confidence"}) {
      if (const std::string* value = node.Find(name)) Range(node, name, *value);
    }
    Content(node, "trace", false);
    const auto found = Own(node, "trace");
    const std::size_t traces = found.size();
    for (std::size_t i = 0; i < traces; ++i) {
      if (i > 0) Say(*found[i], "a second <trace>");
      Trace(*found[i]);
    }
    if (traces > 0 && node.Has("value")) Say(node, "value and <trace> together", "give one");
    if (node.name == "dimension" && traces == 0 && !node.Has("value")) {
      Say(node, "<dimension> without value or <trace>");
    }
  }

  void Name(const vm::xml::Node& node, const std::string& set) {
    const std::size_t hash = set.find('#');
    if (hash == std::string::npos) return;
    const std::string id = set.substr(hash + 1);
    const std::string name = node.Get("name");
    bool known = true;
    if (hash == 0) {
      const auto own = own_.find(id);
      known = own == own_.end() || own->second.second.contains(name);
    } else if (set.starts_with(kVocabularies)) {
      const EmotionVocabulary* vocabulary = FindEmotionVocabulary(id);
      known = !vocabulary || HasWord(vocabulary->names, name);
    }
    if (!known) Say(node, "'" + name + "' is not in the vocabulary " + set);
  }

  void Token(const vm::xml::Node& node, const char* attribute) {
    const std::string* value = node.Find(attribute);
    if (value && !IsToken(*value)) {
      Say(node, std::string(attribute) + " '" + *value + "'", "expected a name without blanks");
    }
  }
  void Uri(const vm::xml::Node& node, const char* attribute) {
    const std::string* value = node.Find(attribute);
    if (value && !IsUri(*value)) {
      Say(node, std::string(attribute) + " '" + *value + "'", "expected a URI");
    }
  }

  void Range(const vm::xml::Node& node, const std::string& what, std::string_view text) {
    const auto value = Number(text);
    if (!value || *value < 0 || *value > 1) {
      Say(node, what + " '" + std::string(text) + "'", "expected 0.0 to 1.0");
    }
  }

  void Trace(const vm::xml::Node& node) {
    Attributes(node, "freq samples", "freq samples");
    Content(node, "", false);
    const std::string frequency = node.Get("freq");
    const std::string number(vm::xml::Trim(frequency.substr(0, frequency.find("Hz"))));
    const auto value = Number(number);
    if (node.Has("freq") && (!value || *value <= 0 || !vm::xml::Trim(frequency).ends_with("Hz"))) {
      Say(node, "freq '" + frequency + "'", "expected a number above 0 and Hz, as 10Hz");
    }
    const std::string samples = node.Get("samples");
    const auto words = SplitWords(samples);
    if (node.Has("samples") && words.empty()) Say(node, "a <trace> without samples");
    for (const std::string_view word : words) Range(node, "sample", word);
  }

  void Reference(const vm::xml::Node& node) {
    Attributes(node, "uri role media-type", "uri");
    Content(node, "", false);
    Uri(node, "uri");
    if (const std::string* type = node.Find("media-type"); type && !IsMediaType(*type)) {
      Say(node, "media-type '" + *type + "'", "expected TYPE/SUBTYPE");
    }
    const std::string role = node.Get("role", "expressedBy");
    if (!HasWord("expressedBy experiencedBy triggeredBy targetedAt", role)) {
      Say(node, "role '" + role + "'",
          "expected expressedBy, experiencedBy, triggeredBy or targetedAt");
    }
  }

  const vm::xml::Node& root_;
  std::vector<Finding> findings_;
  std::set<std::string> ids_;
  std::map<std::string, std::pair<std::string, std::set<std::string>>> own_;
};

}  // namespace

bool IsEmotionMl(const vm::xml::Node& root) {
  return root.IsElement("emotionml") ||
         (root.IsElement("emotion") && root.space == kEmotionMlSpace);
}

std::vector<Finding> CheckEmotionMl(const vm::xml::Node& root) {
  return EmotionChecker(root).Run();
}

}  // namespace vxml
