#include "face_track/model/seen_face.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <stdexcept>

#include "embedded/seen_face.h"
#include "fsm/base/table_reader.h"
#include "vm_protocol/core/or_throw.h"

namespace facetrack {
namespace {

constexpr float kUnit = 100;  // numbers of the table are hundredths of a millimetre

glm::mat3 About(int axis, float angle) {
  const float c = std::cos(angle), s = std::sin(angle);
  if (axis == 0) return {1, 0, 0, 0, c, s, 0, -s, c};
  if (axis == 1) return {c, 0, -s, 0, 1, 0, s, 0, c};
  return {c, s, 0, -s, c, 0, 0, 0, 1};
}

Points PointsOf(const fsm::TableRow& row, std::size_t from) {
  const std::vector<float> numbers = row.Numbers(from);
  if (numbers.size() != 3 * kPoints) {
    row.Refuse(fmt::format("{} numbers found, {} expected", numbers.size(), 3 * kPoints));
  }
  Points points;
  for (std::size_t i = 0; i < kPoints; ++i) {
    points.push_back(glm::vec3(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]) / kUnit);
  }
  return points;
}

std::vector<float> ScalarsOf(const fsm::TableRow& row, std::size_t from) {
  std::vector<float> numbers = row.Numbers(from);
  if (numbers.size() != kPoints) {
    row.Refuse(fmt::format("{} numbers found, {} expected", numbers.size(), kPoints));
  }
  for (float& v : numbers) v /= kUnit;
  return numbers;
}

/// The channel a row names by kind, number and side, from word `from` on.
Channel NamedBy(const fsm::TableRow& row, std::size_t kind, std::size_t from) {
  Channel channel;
  channel.kind = static_cast<Channel::Kind>(kind);
  channel.unit = row.Integer(from);
  channel.side = row.Word(from + 1) == "-" ? "" : row.Word(from + 1);
  return channel;
}

constexpr std::string_view kKinds[] = {"unit", "gaze_down", "gaze_right"};

/// In which ways heads differ, and how much so with each channel.
void ReadVariations(const fsm::Table& table, SeenFace& face) {
  const auto rows = table.RowsOf("variation");
  if (rows.size() > SeenFace::kMostVariations) table.Refuse("too many rows 'variation'");
  for (const fsm::TableRow& row : rows) {
    const auto numbers = row.Numbers(1);
    if (numbers.size() != 2 * kPoints) {
      row.Refuse(fmt::format("{} numbers found, {} expected", numbers.size(), 2 * kPoints));
    }
    auto& variation = face.variations.emplace_back();
    for (std::size_t i = 0; i < kPoints; ++i) {
      variation.push_back(glm::vec2(numbers[2 * i], numbers[2 * i + 1]) / kUnit);
    }
  }
  face.remainder = ScalarsOf(table.Only("remainder"), 1);
  for (const fsm::TableRow& row : table.RowsOf("varies")) {
    const auto kind = std::ranges::find(kKinds, row.Word(1));
    if (kind == std::end(kKinds)) row.Refuse("expected unit, gaze_down or gaze_right");
    const auto name = NamedBy(row, static_cast<std::size_t>(kind - kKinds), 2).Name();
    const auto at = std::ranges::find(face.channels, name, &Channel::Name);
    if (at == face.channels.end()) row.Refuse("how " + name + " moves is not told");
    if (!at->varies.empty()) row.Refuse(name + " is told twice");
    at->varies = row.Numbers(4);
    if (at->varies.size() != rows.size()) {
      row.Refuse(fmt::format("{} numbers found, {} expected, one a row 'variation'",
                             at->varies.size(), rows.size()));
    }
    for (float& v : at->varies) {
      if (v < 0) row.Refuse("expected numbers of 0 or more");
      v /= kUnit;
    }
  }
  for (const Channel& channel : face.channels) {
    if (channel.varies.size() != rows.size()) {
      table.Refuse("expected a row 'varies' of " + channel.Name());
    }
  }
}

SeenFace Read(const fsm::Table& table) {
  SeenFace face;
  face.rest = PointsOf(table.Only("rest"), 1);
  face.depth = ScalarsOf(table.Only("depth"), 1);
  face.spread = ScalarsOf(table.Only("spread"), 1);
  const auto slides = table.RowsOf("slide");
  if (slides.size() != 2 * SeenFace::kSlides) table.Refuse("expected 18 rows 'slide'");
  face.slide.resize(kPoints);
  for (std::size_t k = 0; k < slides.size(); ++k) {
    const auto values = ScalarsOf(slides[k], 1);
    for (std::size_t i = 0; i < kPoints; ++i) {
      face.slide[i][k / 2][static_cast<glm::length_t>(k % 2)] = values[i];
    }
  }
  for (std::size_t kind = 0; kind < 3; ++kind) {
    for (const fsm::TableRow& row : table.RowsOf(kKinds[kind])) {
      Channel channel = NamedBy(row, kind, 1);
      const float dose = row.Number(3);
      auto at = std::ranges::find(face.channels, channel.Name(), &Channel::Name);
      if (at == face.channels.end()) {
        face.channels.push_back(std::move(channel));
        at = face.channels.end() - 1;
      }
      if (dose == 0 || (!at->doses.empty() && !(dose > at->doses.back()))) {
        row.Refuse("expected doses that rise, without 0");
      }
      at->doses.push_back(dose);
      at->motion.push_back(PointsOf(row, 4));
    }
  }
  ReadVariations(table, face);
  return face;
}

void Add(std::string& text, float value) {
  const long number = std::lround(value * kUnit);
  text += ' ' + std::to_string(number);
}
void Add(std::string& text, const Points& points) {
  for (const glm::vec3& p : points) {
    for (int k = 0; k < 3; ++k) Add(text, p[k]);
  }
}

}  // namespace

glm::mat3 TurnOf(const fsm::Angles& degrees) {
  return About(1, glm::radians(degrees[fsm::kToRight])) *
         About(0, glm::radians(degrees[fsm::kDown])) *
         About(2, -glm::radians(degrees[fsm::kTilted]));
}

std::string Channel::Name() const {
  return (kind == Kind::kUnit ? std::to_string(unit)
                              : std::string(kKinds[static_cast<std::size_t>(kind)])) +
         side;
}

std::array<int, 2> Channel::Piece(float dose) const {
  // The doses with 0 among them; -1 stands for 0.
  const auto zero = static_cast<int>(std::ranges::count_if(doses, [](float d) { return d < 0; }));
  const int count = static_cast<int>(doses.size()) + 1;
  const auto value = [&](int k) {
    return k == zero ? 0 : doses[static_cast<std::size_t>(k < zero ? k : k - 1)];
  };
  int upper = 1;
  while (upper + 1 < count && dose >= value(upper)) ++upper;
  const auto index = [&](int k) { return k == zero ? -1 : k < zero ? k : k - 1; };
  return {index(upper - 1), index(upper)};
}

glm::vec3 Channel::Slope(std::size_t point, float dose) const {
  const auto [a, b] = Piece(dose);
  const auto at = [&](int k) {
    return k < 0 ? glm::vec3(0) : motion[static_cast<std::size_t>(k)][point];
  };
  const auto value = [&](int k) { return k < 0 ? 0 : doses[static_cast<std::size_t>(k)]; };
  return (at(b) - at(a)) / (value(b) - value(a));
}

glm::vec3 Channel::At(std::size_t point, float dose) const {
  if (dose == 0) return glm::vec3(0);
  const int from = Piece(dose)[0];
  const glm::vec3 begin = from < 0 ? glm::vec3(0) : motion[static_cast<std::size_t>(from)][point];
  const float begins = from < 0 ? 0 : doses[static_cast<std::size_t>(from)];
  return begin + (dose - begins) * Slope(point, dose);
}

std::array<float, SeenFace::kSlides> SeenFace::SlideTerms(float down, float right) {
  constexpr float kScale = 30, kMost = 1.6F;  // the learned pictures end there
  const float p = std::clamp(down / kScale, -kMost, kMost),
              y = std::clamp(right / kScale, -kMost, kMost);
  return {y, p, y * y, y * p, p * p, y * y * y, y * y * p, y * p * p, p * p * p};
}

glm::vec2 SeenFace::Slide(std::size_t point, float down, float right) const {
  const auto terms = SlideTerms(down, right);
  glm::vec2 sum(0);
  for (std::size_t k = 0; k < kSlides; ++k) sum += terms[k] * slide[point][k];
  return sum;
}

std::size_t SeenFace::Find(std::string_view name) const {
  const auto at = std::ranges::find(channels, name, &Channel::Name);
  if (at == channels.end()) throw std::out_of_range("no channel " + std::string(name));
  return static_cast<std::size_t>(at - channels.begin());
}

vm::Result<SeenFace> SeenFace::Parse(const std::string& name, std::string_view text) {
  return fsm::ReadTable(name, text, Read);
}

std::string SeenFace::Print() const {
  std::string text =
      "# What the landmark network sees of our heads; face_track_learn makes this file\n"
      "# (docs/tracking.md). Numbers are hundredths of a millimetre on a head whose outer corners\n"
      "# of the eyes lie 90 mm apart: x to the viewer's right, y up, z to the viewer. 470 points:\n"
      "# the network's 468, then the middles of the right and the left iris.\n"
      "#\n"
      "# rest X Y Z ...       where they lie on a usual head\n"
      "# depth Z ...          the depth the network gives them there\n"
      "# spread S ...         how far they lie otherwise on other heads that turn\n"
      "# slide V ...          rows of x and y in turn, factors of y p yy yp pp yyy yyp ypp ppp,\n"
      "#                      y and p the turn to the right and down in parts of 30 degrees:\n"
      "#                      how far from where they are they are seen\n"
      "# unit NUMBER SIDE DOSE X Y Z ...   how they move with a unit of FACS; SIDE L, R, - (both)\n"
      "# gaze_down, gaze_right 0 SIDE DEGREES X Y Z ...   likewise as an eye turns\n"
      "# variation X Y ...    a way in which heads differ in how they move, 1 mm rms\n"
      "# remainder S ...      how far they move otherwise in other ways\n"
      "# varies KIND NUMBER SIDE S ...     by how much along each variation, at dose 1 or 20 "
      "degrees\n";
  text += "rest";
  Add(text, rest);
  text += "\ndepth";
  for (const float v : depth) Add(text, v);
  text += "\nspread";
  for (const float v : spread) Add(text, v);
  for (std::size_t k = 0; k < 2 * kSlides; ++k) {
    text += "\nslide";
    for (const auto& s : slide) Add(text, s[k / 2][static_cast<glm::length_t>(k % 2)]);
  }
  for (const Channel& channel : channels) {
    for (std::size_t k = 0; k < channel.doses.size(); ++k) {
      text +=
          fmt::format("\n{} {} {} {:g}", kKinds[static_cast<std::size_t>(channel.kind)],
                      channel.unit, channel.side.empty() ? "-" : channel.side, channel.doses[k]);
      Add(text, channel.motion[k]);
    }
  }
  for (const auto& variation : variations) {
    text += "\nvariation";
    for (const glm::vec2 p : variation) Add(text, p.x), Add(text, p.y);
  }
  text += "\nremainder";
  for (const float v : remainder) Add(text, v);
  for (const Channel& channel : channels) {
    text += fmt::format("\nvaries {} {} {}", kKinds[static_cast<std::size_t>(channel.kind)],
                        channel.unit, channel.side.empty() ? "-" : channel.side);
    for (const float v : channel.varies) Add(text, v);
  }
  return text + "\n";
}

const SeenFace& SeenFace::Shipped() {
  static const SeenFace face = vm::OrThrow(Parse("seen_face.txt", embedded::seen_face()));
  return face;
}

std::vector<std::size_t> MirroredPoints(const std::vector<Points>& faces) {
  struct Pair {
    float apart;
    std::size_t a, b;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < facefit::kNetworkPoints; ++a) {
    for (std::size_t b = a; b < facefit::kNetworkPoints; ++b) {
      float apart = 0;
      for (const Points& points : faces) {
        apart += glm::distance(points[a], points[b] * glm::vec3(-1, 1, 1));
      }
      pairs.push_back({apart, a, b});
    }
  }
  std::ranges::sort(pairs, {}, &Pair::apart);
  constexpr std::size_t kNone = kPoints;
  std::vector<std::size_t> mirrored(kPoints, kNone);
  for (const auto& [apart, a, b] : pairs) {
    if (mirrored[a] != kNone || mirrored[b] != kNone) continue;
    mirrored[a] = b;
    mirrored[b] = a;
  }
  mirrored[kIris] = kIris + 1;
  mirrored[kIris + 1] = kIris;
  return mirrored;
}

}  // namespace facetrack
