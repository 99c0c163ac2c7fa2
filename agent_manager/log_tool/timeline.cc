// Draws the timeline of a session.

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

/// XML does not allow control characters, even escaped.
std::string Escape(std::string text) {
  std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  return vm::EscapeXml(text);
}

std::string Number(double value) {
  const long tenths = std::lround(value * 10);
  return std::to_string(tenths / 10) + "." + std::to_string(std::abs(tenths % 10));
}

/// Returns 1, 2 or 5 times a power of ten, so that the span has about ten steps.
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

/// The drawing: one lane for each name, time to the right.
class Timeline {
 public:
  explicit Timeline(const std::vector<Entry>& entries) {
    for (const Entry& entry : entries) {
      AddLane(entry.log.sender);
      for (const std::string& receiver : entry.receivers) AddLane(receiver);
    }
    if (!entries.empty()) {
      first_ms_ = vm::InMs(entries.front().log.time);
      last_ms_ = std::max(vm::InMs(entries.back().log.time), first_ms_ + 1);
    }
    scale_ = (kWidth - kLeft - kRight) / (last_ms_ - first_ms_);
    height_ = kTop + kLane * static_cast<double>(names_.size()) + 30;
    svg_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + Number(kWidth) + "\" height=\"" +
           Number(height_) +
           "\" font-family=\"sans-serif\" font-size=\"11\">\n"
           "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n";
  }
  void DrawGrid() {
    const double step = NiceStep(last_ms_ - first_ms_);
    for (double at = std::ceil(first_ms_ / step) * step; at <= last_ms_; at += step) {
      const std::string place = Number(kLeft + (at - first_ms_) * scale_);
      svg_ += Line(place, Number(kTop - 8), place, Number(height_ - 30), "#e5e7e9") +
              "/><text x=\"" + place + "\" y=\"" + Number(kTop - 14) +
              "\" text-anchor=\"middle\" fill=\"#566573\">" + Number(at) + " ms</text>\n";
    }
    for (std::size_t i = 0; i < names_.size(); ++i) {
      svg_ += Line(Number(kLeft), Number(Y(i)), Number(kWidth - kRight), Number(Y(i)), "#aeb6bf") +
              "/><text x=\"8\" y=\"" + Number(Y(i) + 4) + "\" font-weight=\"bold\">" +
              Escape(names_[i]) + "</text>\n";
    }
  }
  void Draw(const Exchange& exchange) {
    if (!exchange.answered || !lanes_.contains(exchange.to)) return;
    svg_ += "<rect x=\"" + Number(X(exchange.asked)) + "\" y=\"" +
            Number(Y(lanes_.at(exchange.to)) - 5) + "\" height=\"10\" width=\"" +
            Number(std::max(1.0, X(*exchange.answered) - X(exchange.asked))) + "\" fill=\"" +
            (exchange.refused ? "#f5b7b1" : "#abebc6") + "\"><title>" +
            Escape("@" + exchange.from + " asked @" + exchange.to + " " + exchange.slot + ": " +
                   vm::FormatMs(*exchange.answered - exchange.asked) + " ms") +
            "</title></rect>\n";
  }
  void Draw(const Entry& entry) {
    const std::size_t from = lanes_.at(entry.log.sender);
    const double at = X(entry.log.time);
    const std::string colour(ColourOf(entry.message));
    const std::string title =
        "<title>" +
        Escape(vm::FormatMs(entry.log.time) + " ms @" + entry.log.sender + ": " + entry.log.line) +
        "</title>";
    for (const std::string& receiver : entry.receivers) {
      svg_ +=
          Line(Number(at), Number(Y(from)), Number(at), Number(Y(lanes_.at(receiver))), colour) +
          " stroke-opacity=\"0.35\">" + title + "</line>\n";
    }
    svg_ += "<circle cx=\"" + Number(at) + "\" cy=\"" + Number(Y(from)) + "\" r=\"3\" fill=\"" +
            colour + "\">" + title + "</circle>\n";
    DrawLabel(entry.message, from, at, colour);
  }
  std::string Finish() const { return svg_ + "</svg>\n"; }

 private:
  double X(vm::Time time) const { return kLeft + (vm::InMs(time) - first_ms_) * scale_; }
  static double Y(std::size_t lane) { return kTop + kLane * (static_cast<double>(lane) + 0.5); }
  /// Without its end.
  static std::string Line(const std::string& x1, const std::string& y1, const std::string& x2,
                          const std::string& y2, const std::string& colour) {
    return "<line x1=\"" + x1 + "\" x2=\"" + x2 + "\" y1=\"" + y1 + "\" y2=\"" + y2 +
           "\" stroke=\"" + colour + "\"";
  }
  void AddLane(const std::string& name) {
    if (lanes_.emplace(name, names_.size()).second) names_.push_back(name);
  }
  void DrawLabel(const vm::Message& message, std::size_t lane, double at,
                 const std::string& colour) {
    std::string label = message.slot + (message.value.empty() ? "" : " = ") + message.value;
    if (label.size() > kMaxLabel) label = std::string(vm::CutUtf8(label, kMaxLabel)) + "...";
    if (at < label_end_[lane]) return;
    label_end_[lane] = at + 5.5 * static_cast<double>(label.size()) + 8;
    svg_ += "<text x=\"" + Number(at + 4) + "\" y=\"" + Number(Y(lane) - 9) + "\" fill=\"" +
            colour + "\">" + Escape(label) + "</text>\n";
  }

  std::map<std::string, std::size_t> lanes_;
  std::vector<std::string> names_;  // by lane
  double first_ms_ = 0, last_ms_ = 1, scale_ = 1, height_ = 0;
  std::map<std::size_t, double> label_end_;  // by lane: labels do not overlap
  std::string svg_;
};

}  // namespace

std::string TimelineSvg(const std::vector<Entry>& entries, const std::vector<Exchange>& exchanges) {
  Timeline timeline(entries);
  timeline.DrawGrid();
  for (const Exchange& exchange : exchanges) timeline.Draw(exchange);
  for (const Entry& entry : entries) timeline.Draw(entry);
  return timeline.Finish();
}

}  // namespace am
