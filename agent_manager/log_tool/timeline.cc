// The timeline of a session as a picture.

#include <algorithm>
#include <cmath>
#include <map>

#include "agent_manager/log_tool/entries.h"
#include "vm_protocol/core/utf8.h"
#include "vm_protocol/core/xml_text.h"

namespace am {
namespace {

constexpr double kLeft = 110, kRight = 20, kTop = 40, kLane = 56, kWidth = 1200;  // pixels
constexpr std::size_t kMaxLabel = 28;                                             // bytes

/// Control characters may not stand in XML at all.
std::string Escape(std::string text) {
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  return vm::EscapeXml(text);
}

std::string Number(double value) {
  const long tenths = std::lround(value * 10);
  return std::to_string(tenths / 10) + "." + std::to_string(std::abs(tenths % 10));
}

/// 1, 2 or 5 times a power of ten, so that about ten of them make up the span.
double NiceStep(double span_ms) {
  const double power = std::pow(10.0, std::floor(std::log10(std::max(span_ms, 1.0) / 10)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (span_ms / (power * factor) <= 12) return power * factor;
  }
  return power * 10;
}

std::string_view ColourOf(const vm::Message& message) {
  if (message.slot.ends_with(".error") || message.slot == "Error") return "#c0392b";
  switch (message.command) {
    case vm::Command::kRep:
      return "#2e86c1";
    case vm::Command::kTell:
      return "#7d3c98";
    case vm::Command::kInq:
      return "#7f8c8d";
    default:
      return "#1e8449";
  }
}

}  // namespace

std::string TimelineSvg(const std::vector<Entry>& entries, const std::vector<Exchange>& exchanges) {
  std::map<std::string, std::size_t> lanes;
  std::vector<std::string> names;
  const auto lane = [&](const std::string& name) {
    const auto [at, added] = lanes.emplace(name, names.size());
    if (added) names.push_back(name);
    return at->second;
  };
  for (const Entry& entry : entries) {
    lane(entry.log.sender);
    for (const std::string& receiver : entry.receivers) lane(receiver);
  }
  const auto ms = [](vm::Time time) { return static_cast<double>(time.count()) / 1000; };
  const double first = entries.empty() ? 0 : ms(entries.front().log.time);
  const double last = entries.empty() ? 1 : std::max(ms(entries.back().log.time), first + 1);
  const double scale = (kWidth - kLeft - kRight) / (last - first);
  const auto x = [&](vm::Time time) { return kLeft + (ms(time) - first) * scale; };
  const auto y = [&](std::size_t number) {
    return kTop + kLane * (static_cast<double>(number) + 0.5);
  };
  const double height = kTop + kLane * static_cast<double>(names.size()) + 30;
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Number(kWidth) +
                    "\" height=\"" + Number(height) +
                    "\" font-family=\"sans-serif\" font-size=\"11\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  const double step = NiceStep(last - first);
  for (double at = std::ceil(first / step) * step; at <= last; at += step) {
    const std::string place = Number(kLeft + (at - first) * scale);
    svg += "<line x1=\"" + place + "\" x2=\"" + place + "\" y1=\"" + Number(kTop - 8) + "\" y2=\"" +
           Number(height - 30) + "\" stroke=\"#e5e7e9\"/><text x=\"" + place + "\" y=\"" +
           Number(kTop - 14) + "\" text-anchor=\"middle\" fill=\"#566573\">" + Number(at) +
           " ms</text>\n";
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    svg += "<line x1=\"" + Number(kLeft) + "\" x2=\"" + Number(kWidth - kRight) + "\" y1=\"" +
           Number(y(i)) + "\" y2=\"" + Number(y(i)) + "\" stroke=\"#aeb6bf\"/><text x=\"8\" y=\"" +
           Number(y(i) + 4) + "\" font-weight=\"bold\">" + Escape(names[i]) + "</text>\n";
  }
  for (const Exchange& exchange : exchanges) {
    if (!exchange.answered || !lanes.contains(exchange.to)) continue;
    svg += "<rect x=\"" + Number(x(exchange.asked)) + "\" y=\"" +
           Number(y(lanes.at(exchange.to)) - 5) + "\" height=\"10\" width=\"" +
           Number(std::max(1.0, x(*exchange.answered) - x(exchange.asked))) + "\" fill=\"" +
           (exchange.refused ? "#f5b7b1" : "#abebc6") + "\"><title>" +
           Escape("@" + exchange.from + " asked @" + exchange.to + " " + exchange.slot + ": " +
                  vm::FormatMs(*exchange.answered - exchange.asked) + " ms") +
           "</title></rect>\n";
  }
  std::map<std::size_t, double> label_end;  // by lane: labels do not lie on each other
  for (const Entry& entry : entries) {
    const std::size_t from = lanes.at(entry.log.sender);
    const double at = x(entry.log.time);
    const std::string colour(ColourOf(entry.message));
    const std::string title =
        "<title>" +
        Escape(vm::FormatMs(entry.log.time) + " ms @" + entry.log.sender + ": " + entry.log.line) +
        "</title>";
    for (const std::string& receiver : entry.receivers) {
      svg += "<line x1=\"" + Number(at) + "\" x2=\"" + Number(at) + "\" y1=\"" + Number(y(from)) +
             "\" y2=\"" + Number(y(lanes.at(receiver))) + "\" stroke=\"" + colour +
             "\" stroke-opacity=\"0.35\">" + title + "</line>\n";
    }
    svg += "<circle cx=\"" + Number(at) + "\" cy=\"" + Number(y(from)) + "\" r=\"3\" fill=\"" +
           colour + "\">" + title + "</circle>\n";
    std::string label =
        entry.message.slot + (entry.message.value.empty() ? "" : " = ") + entry.message.value;
    if (label.size() > kMaxLabel) label = std::string(vm::CutUtf8(label, kMaxLabel)) + "...";
    if (at < label_end[from]) continue;
    label_end[from] = at + 5.5 * static_cast<double>(label.size()) + 8;
    svg += "<text x=\"" + Number(at + 4) + "\" y=\"" + Number(y(from) - 9) + "\" fill=\"" + colour +
           "\">" + Escape(label) + "</text>\n";
  }
  return svg + "</svg>\n";
}

}  // namespace am
