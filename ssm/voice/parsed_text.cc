#include "ssm/voice/parsed_text.h"

#include <tinyxml2.h>

#include "ssm/voice/span_builder.h"
#include "vm_protocol/core/xml_text.h"

namespace ssm {
namespace {

using tinyxml2::XMLElement;

constexpr int kMaxDepth = 64;

void Write(const XMLElement& element, int depth, std::string& text) {
  if (depth > kMaxDepth) return;
  const std::string_view name = element.Name();
  const char* written = element.Attribute("orth");
  if ((name == "W2" || name == "PRON") && written != nullptr) {
    const char* reading = element.Attribute("pron");
    const bool kana = reading != nullptr && IsKanaReading(reading);
    text += kana
                ? "<PRON SYM=\"" + std::string(reading) + "\">" + vm::EscapeXml(written) + "</PRON>"
                : vm::EscapeXml(written);
    return;  // what a word is made of says the same again
  }
  const bool tag = name != "S" && name != "AP" && name != "W1" && depth > 0;
  if (tag) {
    text += "<" + std::string(name);
    for (auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
      text += " " + std::string(a->Name()) + "=\"" + vm::EscapeXml(a->Value()) + "\"";
    }
    text += element.NoChildren() ? "/>" : ">";
  }
  for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
    Write(*child, depth + 1, text);
  }
  if (tag && !element.NoChildren()) text += "</" + std::string(name) + ">";
}

}  // namespace

vm::Result<std::string> TextOfParsed(std::string_view xml) {
  const std::string whole = "<parsed>" + std::string(xml) + "</parsed>";
  tinyxml2::XMLDocument document;
  if (xml.contains("<!") || xml.contains("<?") ||
      document.Parse(whole.data(), whole.size()) != tinyxml2::XML_SUCCESS) {
    return vm::Fail(vm::Errc::kSyntax,
                    "line " + std::to_string(document.ErrorLineNum()) + ": the XML is broken");
  }
  std::string text;
  Write(*document.RootElement(), 0, text);
  if (text.empty()) return vm::Fail(vm::Errc::kBadValue, "there is no <W2 orth=... pron=...>");
  return text;
}

}  // namespace ssm
