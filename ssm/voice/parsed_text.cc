#include "ssm/voice/parsed_text.h"

#include "ssm/voice/span_builder.h"
#include "vm_protocol/core/xml_text.h"
#include "vm_protocol/xml/parser.h"

namespace ssm {
namespace {

constexpr std::size_t kMaxDepth = 64;

void Write(const vm::xml::Node& element, std::string& text) {
  const std::string& name = element.name;
  const std::string* written = element.Find("orth");
  if ((name == "W2" || name == "PRON") && written != nullptr) {
    const std::string reading = element.Get("pron");
    text += IsKanaReading(reading)
                ? "<PRON SYM=\"" + reading + "\">" + vm::EscapeXml(*written) + "</PRON>"
                : vm::EscapeXml(*written);
    return;  // what a word is made of says the same again
  }
  const bool tag = name != "S" && name != "AP" && name != "W1" && element.parent != nullptr;
  if (tag) {
    text += "<" + name;
    for (const auto& attribute : element.attributes) {
      text += " " + attribute.name + "=\"" + vm::EscapeXml(attribute.value) + "\"";
    }
    text += element.children.empty() ? "/>" : ">";
  }
  for (const auto& child : element.children) {
    if (child->IsElement()) Write(*child, text);
  }
  if (tag && !element.children.empty()) text += "</" + name + ">";
}

}  // namespace

vm::Result<std::string> TextOfParsed(std::string_view xml) {
  if (xml.contains("<!") || xml.contains("<?")) {
    return vm::Fail(vm::Errc::kSyntax, "declarations and instructions are not read");
  }
  vm::xml::Limits limits;
  limits.depth = kMaxDepth;
  const auto document =
      vm::xml::Parse("<parsed>" + std::string(xml) + "</parsed>", "parsed text", "", limits);
  if (!document) return std::unexpected(document.error());
  std::string text;
  Write(*document->root, text);
  if (text.empty()) return vm::Fail(vm::Errc::kBadValue, "there is no <W2 orth=... pron=...>");
  return text;
}

}  // namespace ssm
