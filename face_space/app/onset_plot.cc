#include "face_space/app/onset_plot.h"

#include <fmt/format.h>

#include <algorithm>

namespace facespace {
namespace {

constexpr double kWide = 1200, kTall = 200, kLeft = 60, kGap = 40;
constexpr std::size_t kMostPoints = 2400;  // two for each pixel of the width
struct Part {
  const char *name, *colour;
};
constexpr ByRegion<Part> kParts{{{"eyes", "#2464b4"}, {"brows", "#2e8b57"}, {"mouth", "#c0392b"}}};

std::string Escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

}  // namespace

void OnsetPlot::Add(const UnitTrack& track, const std::vector<ByRegion<double>>& courses,
                    const std::vector<Onset>& onsets) {
  if (panels_.size() == kMostPanels || track.ms.empty()) return;
  const double top = kGap + static_cast<double>(panels_.size()) * (kTall + kGap);
  const double first = track.ms.front(), length = std::max(track.ms.back() - first, 1.0);
  double most = 1;
  for (const ByRegion<double>& parts : courses) most = std::max(most, std::ranges::max(parts));
  const auto x = [&](double ms) { return kLeft + kWide * (ms - first) / length; };
  const auto y = [&](double strength) { return top + kTall * (1 - strength / most); };
  std::string panel = fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#999\"/>\n"
      "<text x=\"{}\" y=\"{}\">{}, {:.0f} to {:.0f} ms; strength of units to {:.2f}</text>\n",
      kLeft, top, kWide, kTall, kLeft, top - 8, Escaped(track.name), first, first + length, most);
  const std::size_t step = courses.size() / kMostPoints + 1;
  for (std::size_t region = 0; region < fsm::kRegions; ++region) {
    const Part& part = kParts[region];
    panel += fmt::format("<polyline fill=\"none\" stroke=\"{}\" points=\"", part.colour);
    for (std::size_t i = 0; i < courses.size(); i += step)
      panel += fmt::format("{:.1f},{:.1f} ", x(track.ms[i]), y(courses[i][region]));
    panel += fmt::format("\"/>\n<text x=\"4\" y=\"{}\" fill=\"{}\">{}</text>\n",
                         top + 20 + 18 * static_cast<double>(region), part.colour, part.name);
    for (const Onset& onset : onsets) {
      if (!onset.lag_ms[region]) continue;
      const double at = x(onset.begins_ms + *onset.lag_ms[region]);
      panel += fmt::format(
          "<line x1=\"{0:.2f}\" x2=\"{0:.2f}\" y1=\"{1}\" y2=\"{2}\" stroke=\"{3}\" "
          "stroke-dasharray=\"3 3\"/>\n",
          at, top, top + kTall, part.colour);
    }
  }
  panels_.push_back(std::move(panel));
}

std::string OnsetPlot::Svg() const {
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{:.0f}\" height=\"{:.0f}\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
      kLeft + kWide + kGap, kGap + static_cast<double>(panels_.size()) * (kTall + kGap));
  for (const std::string& panel : panels_) svg += panel;
  return svg + "</svg>\n";
}

}  // namespace facespace
