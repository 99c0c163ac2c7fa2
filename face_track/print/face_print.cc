#include "face_track/print/face_print.h"

#include <fmt/format.h>

#include <algorithm>

#include "embedded/arkit_of_units.h"
#include "fsm/base/parse_number.h"
#include "fsm/base/table_reader.h"

namespace facetrack {
namespace {

constexpr const char* kSides[] = {"R", "L"};

std::string Number(float value, int digits = 3) {
  std::string text = fmt::format("{:.{}f}", value, digits);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

}  // namespace

FacePrint::FacePrint(Format format, Extras extras, const SeenFace& face)
    : format_(format), extras_(format == Format::kArkit ? Extras{} : extras), face_(face) {
  const fsm::Table table("arkit.txt", embedded::arkit_of_units());
  for (const fsm::TableRow& row : table.rows()) {
    Shape shape{.name = row.key(), .parts = {}};
    for (std::size_t k = 1; k < row.size(); ++k) {
      const std::string& word = row.Word(k);
      const auto colon = word.find(':');
      if (colon == std::string::npos) row.Refuse("CHANNEL:WEIGHT expected");
      shape.parts.emplace_back(face_.Find(word.substr(0, colon)),
                               std::stof(word.substr(colon + 1)));
    }
    shapes_.push_back(std::move(shape));
  }
}

std::vector<FacePrint::Column> FacePrint::Columns(const FaceLine& line) const {
  std::vector<Column> columns;
  if (format_ == Format::kArkit) {
    for (const Shape& shape : shapes_) {
      float sum = 0;
      for (const auto& [channel, weight] : shape.parts) sum += weight * line.units[channel];
      columns.push_back({shape.name, std::clamp(sum, 0.0F, 1.0F)});
    }
  }
  columns.push_back({"down", line.head[fsm::kDown]});
  columns.push_back({"right", line.head[fsm::kToRight]});
  columns.push_back({"tilt", line.head[fsm::kTilted]});
  if (format_ == Format::kArkit) return columns;
  columns.push_back({"x", line.place.x});
  columns.push_back({"y", line.place.y});
  columns.push_back({"z", line.place.z});
  for (std::size_t side : {0U, 1U}) {
    columns.push_back({std::string("lid") + kSides[side], line.lid[side]});
  }
  columns.push_back({"jaw", line.jaw});
  for (std::size_t c = 0; c < face_.channels.size(); ++c) {
    const Channel& channel = face_.channels[c];
    const bool unit = channel.kind == Channel::Kind::kUnit;
    columns.push_back({(unit ? "au" : "") + channel.Name(), line.units[c]});
  }
  columns.push_back({"miss", line.miss});
  if (!extras_.mouth) return columns;
  const TrackedMouth mouth = MouthOfLips::Shipped().Mouth(line.lips);
  columns.push_back({"seal", mouth.seal});
  columns.push_back({"tongue", 0});
  for (std::size_t p = 0; p < mouth.parameters.size(); ++p) {
    columns.push_back({fmt::format("m{}", p + 1), mouth.parameters[p]});
  }
  return columns;
}

std::string FacePrint::Header() const {
  if (format_ == Format::kJsonLines) return "";
  FaceLine none;
  none.units.assign(face_.channels.size(), 0);
  std::string text = "ms,person,certainty";
  for (const Column& column : Columns(none)) text += "," + column.name;
  for (std::size_t i = 0; extras_.points && i < kPoints; ++i)
    text += fmt::format(",x{0},y{0},z{0}", i);
  return text + "\n";
}

std::string FacePrint::Line(const FaceLine& line) const {
  const auto columns = Columns(line);
  const bool json = format_ == Format::kJsonLines;
  const std::string certainty = Number(line.certainty);
  // Who learns from mouths asks for even steps, which tenths of a millisecond would not show.
  const std::string ms = fmt::format("{:.{}f}", line.ms, extras_.mouth ? 3 : 1);
  std::string text =
      json ? fmt::format(R"({{"ms":{},"person":{},"certainty":{})", ms, line.person, certainty)
           : fmt::format("{},{},{}", ms, line.person, certainty);
  for (const Column& column : columns) {
    if (json && line.person == 0) break;
    if (json)
      text += ",\"" + column.name + "\":";
    else
      text += ",";
    if (line.person != 0) text += Number(column.value);
  }
  if (extras_.points && (!json || line.person != 0)) {
    if (json) text += ",\"points\":[";
    for (std::size_t i = 0; i < kPoints; ++i) {
      if (json) text += i == 0 ? "[" : ",[";
      for (int k = 0; k < 3; ++k) {
        if (!json || k > 0) text += ",";
        if (line.person != 0) text += Number(line.points[i][k], 2);
      }
      if (json) text += "]";
    }
    if (json) text += "]";
  }
  return text + (json ? "}\n" : "\n");
}

}  // namespace facetrack
