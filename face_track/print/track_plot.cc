#include "face_track/print/track_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

namespace facetrack {
namespace {

constexpr double kWide = 1200, kTall = 170, kLeft = 70, kGap = 30;

struct Curve {
  const char *name, *colour;
};
constexpr Curve kCurves[6] = {{"down", "#c0392b"},  {"right", "#2464b4"}, {"tilt", "#2e8b57"},
                              {"lid R", "#2464b4"}, {"lid L", "#c0392b"}, {"jaw", "#2464b4"}};
struct Panel {
  const char* title;
  std::size_t first, last;  ///< of its curves
  float low, high;          ///< at least so much is shown
};
constexpr Panel kPanels[] = {
    {"head, degrees", 0, 2, -10, 10}, {"lids", 3, 4, 0, 1.2F}, {"jaw, degrees", 5, 5, 0, 10}};

}  // namespace

void TrackPlot::Add(const FaceLine& line) {
  if (lines_++ % every_ != 0) return;
  moments_.push_back({line.ms,
                      line.person != 0,
                      {line.head[fsm::kDown], line.head[fsm::kToRight], line.head[fsm::kTilted],
                       line.lid[0], line.lid[1], line.jaw}});
  if (moments_.size() < kMostPoints) return;
  for (std::size_t i = 0; 2 * i < moments_.size(); ++i) moments_[i] = moments_[2 * i];
  moments_.resize((moments_.size() + 1) / 2);
  every_ *= 2;
}

std::string TrackPlot::Svg() const {
  const double first = moments_.empty() ? 0 : moments_.front().ms;
  const double length = moments_.empty() ? 1 : std::max(moments_.back().ms - first, 1.0);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      kLeft + kWide + kGap, 3 * (kTall + kGap) + 2 * kGap);
  double top = kGap;
  for (const Panel& panel : kPanels) {
    float low = panel.low, high = panel.high;
    for (const Moment& m : moments_) {
      for (std::size_t c = panel.first; m.seen && c <= panel.last; ++c) {
        low = std::min(low, m.values[c]);
        high = std::max(high, m.values[c]);
      }
    }
    const auto y = [&](float v) { return top + kTall * (high - v) / (high - low); };
    svg += fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#999\"/>\n"
        "<text x=\"{}\" y=\"{}\">{}</text>\n",
        kLeft, top, kWide, kTall, kLeft, top - 6, panel.title);
    for (const float v : {low, 0.0F, high}) {
      svg += fmt::format(
          "<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{:.3g}</text>"
          "<path d=\"M{} {:.1f}h{}\" stroke=\"#ddd\"/>\n",
          kLeft - 6, y(v) + 4, v, kLeft, y(v), kWide);
    }
    for (std::size_t c = panel.first; c <= panel.last; ++c) {
      std::string path;
      bool drawing = false;
      for (const Moment& m : moments_) {
        if (m.seen) {
          path += fmt::format("{}{:.1f} {:.1f}", drawing ? "L" : "M",
                              kLeft + kWide * (m.ms - first) / length, y(m.values[c]));
        }
        drawing = m.seen;
      }
      svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\"/>\n", path, kCurves[c].colour);
      svg += fmt::format("<text x=\"{}\" y=\"{}\" fill=\"{}\">{}</text>\n",
                         kLeft + 140 + 60 * static_cast<double>(c - panel.first), top - 6,
                         kCurves[c].colour, kCurves[c].name);
    }
    top += kTall + kGap;
  }
  svg += fmt::format("<text x=\"{}\" y=\"{}\">{:.1f} s</text>\n", kLeft, top, first / 1000);
  svg += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"end\">{:.1f} s</text>\n", kLeft + kWide,
                     top, (first + length) / 1000);
  return svg + "</svg>\n";
}

vm::Result<void> TrackPlot::Write(const std::string& path) const {
  std::ofstream file(path);
  file << Svg();
  if (!file.flush()) {
    return vm::Fail(vm::Errc::kUnavailable, "the plot cannot be written to '" + path + "'");
  }
  return {};
}

}  // namespace facetrack
