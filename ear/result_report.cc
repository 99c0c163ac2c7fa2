#include "ear/result_report.h"

#include <array>
#include <cstdio>

#include "vm_protocol/core/xml_text.h"

namespace ear {
namespace {

std::string Short(double number) {
  std::array<char, 32> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.3g", number);
  return buffer.data();
}

}  // namespace

std::string FormatResult(const ResultReport& report) {
  std::string xml = "<result start=\"" + vm::FormatMs(report.start) + "\" end=\"" +
                    vm::FormatMs(report.end) + "\">";
  int rank = 0;
  for (const Candidate& candidate : report.candidates) {
    xml += "<candidate rank=\"" + std::to_string(++rank) + "\" confidence=\"" +
           Short(candidate.confidence) + "\" grammar=\"" + vm::EscapeXml(candidate.grammar) +
           "\" tag=\"" + vm::EscapeXml(candidate.tag) + "\">" + vm::EscapeXml(candidate.text) +
           "</candidate>";
  }
  return xml + "</result>";
}

void DeclareResultSlots(vm::SlotMachine& slots) {
  const auto told = [&slots](std::string name, std::string help, bool auto_output) {
    slots.Declare({.name = std::move(name),
                   .grammar = "<text>",
                   .access = vm::Access::kReadOnly,
                   .auto_output = auto_output,
                   .help = std::move(help)});
  };
  told("Result.partial", "The words heard so far; may still change.", true);
  told("Result.grammar", "The grammar that matched, reported before Result; empty without one.",
       true);
  told("Result.tag",
       "The {meaning} of what matched, several with ; between, reported before Result.", true);
  told(
      "Result.xml",
      "The same in XML on one line, reported before Result, best candidate first: <result start=MS "
      "end=MS><candidate rank=1 confidence=C grammar=NAME tag=MEANING>TEXT</candidate></result>; "
      "no candidate where nothing matched.",
      false);
  told("Result", "What was said, if it matched.", true);
  told("NoMatch", "What was heard but fits no active grammar, or not well enough.", true);
  told("NoInput", "Nobody spoke for so many ms (Listen.timeout).", true);
}

void TellResult(vm::SlotMachine& slots, const ResultReport& report, const std::string& heard) {
  const bool matched = !report.candidates.empty();
  if (matched) {
    slots.Report("Result.grammar", report.candidates.front().grammar);
    slots.Report("Result.tag", report.candidates.front().tag);
  }
  slots.Report("Result.xml", FormatResult(report));
  slots.Report(matched ? "Result" : "NoMatch", matched ? report.candidates.front().text : heard);
}

}  // namespace ear
