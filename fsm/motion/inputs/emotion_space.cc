#include "fsm/motion/inputs/emotion_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "fsm/base/table_reader.h"
#include "fsm/motion/base/unit_names.h"

namespace fsm {
namespace {

constexpr std::size_t kMaxUnits = 64, kMaxLayers = 4, kMaxOutputs = 256;
constexpr float kMaxWeight = 1000;

std::vector<float> Through(const std::vector<EmotionSpace::Layer>& layers,
                           std::vector<float> values) {
  for (const EmotionSpace::Layer& layer : layers) {
    std::vector<float> outputs;
    outputs.reserve(layer.rows.size());
    for (const std::vector<float>& row : layer.rows) {
      float sum = 0;
      for (std::size_t i = 0; i < row.size(); ++i) sum += row[i] * values[i];
      outputs.push_back(layer.rectified ? std::max(sum, 0.0f) : sum);
    }
    values = std::move(outputs);
  }
  return values;
}

void ReadUnitNumbers(const TableRow& row, const UnitNames& names, std::vector<int>& units) {
  if (!units.empty()) row.Refuse("a second row of units found, one expected");
  std::set<int> given;
  for (std::size_t i = 1; i < row.size(); ++i) {
    const int unit = row.Integer(i);
    if (!names.IsUnit(unit)) row.Refuse(fmt::format("'{}' is no action unit", row.Word(i)));
    if (!given.insert(unit).second) row.Refuse(fmt::format("unit {} is here twice", unit));
    units.push_back(unit);
  }
  if (units.empty() || units.size() > kMaxUnits) {
    row.Refuse(fmt::format("{} units found, 1 to {} expected", units.size(), kMaxUnits));
  }
}

void BeginLayer(const TableRow& row, std::vector<EmotionSpace::Layer>& layers) {
  if (row.size() != 2 || (row.Word(1) != "relu" && row.Word(1) != "linear")) {
    row.Refuse(row.key() + " relu|linear expected");
  }
  if (layers.size() == kMaxLayers) row.Refuse(fmt::format("more than {} layers", kMaxLayers));
  layers.push_back({.rectified = row.Word(1) == "relu", .rows = {}});
}

void ReadWeights(const TableRow& row, EmotionSpace::Layer& layer) {
  if (layer.rows.size() == kMaxOutputs) row.Refuse(fmt::format("more than {} rows", kMaxOutputs));
  std::vector<float> weights = row.Numbers(1);
  if (!std::ranges::all_of(weights, [](float w) { return std::abs(w) <= kMaxWeight; })) {
    row.Refuse(fmt::format("a weight beyond {} found", kMaxWeight));
  }
  layer.rows.push_back(std::move(weights));
}

/// Checks that each layer has as many inputs as the one before has outputs.
void CheckLayers(const Table& table, const char* key,
                 const std::vector<EmotionSpace::Layer>& layers, std::size_t inputs,
                 std::size_t outputs) {
  for (const EmotionSpace::Layer& layer : layers) {
    for (const std::vector<float>& row : layer.rows) {
      if (row.size() == inputs) continue;
      table.Refuse(
          fmt::format("a row of {} weights found in '{}', {} expected", row.size(), key, inputs));
    }
    inputs = layer.rows.size();
  }
  if (layers.empty() || inputs != outputs) {
    table.Refuse(fmt::format("the layers of '{}' end with {} outputs, {} expected", key,
                             layers.empty() ? 0 : inputs, outputs));
  }
}

}  // namespace

EmotionSpace::Point EmotionSpace::PointOf(std::span<const float> ratios) const {
  const std::vector<float> middle = Through(encoder, {ratios.begin(), ratios.end()});
  return {middle[0], middle[1], middle[2]};
}

std::vector<float> EmotionSpace::RatiosAt(const Point& point) const {
  std::vector<float> ratios = Through(decoder, {point.begin(), point.end()});
  for (float& ratio : ratios) ratio = std::clamp(ratio, 0.0f, 2.0f);
  return ratios;
}

FaceLook EmotionSpace::LookOf(const Point& point) const {
  constexpr float kSeen = 0.02f;  // smaller strengths are noise of the network
  FaceLook look;
  const std::vector<float> ratios = RatiosAt(point);
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (ratios[i] < kSeen) continue;
    const auto unit = static_cast<std::size_t>(units[i]);
    look.au.left[unit] = look.au.right[unit] = ratios[i];
  }
  return look;
}

vm::Result<EmotionSpace> ReadEmotionSpace(const std::string& name, std::string_view text,
                                          const UnitNames& names) {
  return ReadTable(name, text, [&](const Table& table) {
    EmotionSpace space;
    EmotionSpace::Layer* layer = nullptr;
    for (const TableRow& row : table.rows()) {
      const std::string& key = row.key();
      if (key == "units") {
        ReadUnitNumbers(row, names, space.units);
      } else if (key == "encode" || key == "decode") {
        std::vector<EmotionSpace::Layer>& layers = key == "encode" ? space.encoder : space.decoder;
        BeginLayer(row, layers);
        layer = &layers.back();
      } else if (key == "row") {
        if (layer == nullptr) row.Refuse("a row before any layer");
        ReadWeights(row, *layer);
      } else if (key == "emotion") {
        const std::string& emotion = row.Name(1, "an emotion's name");
        const EmotionSpace::Point at{row.Within(2, -2, 2), row.Within(3, -2, 2),
                                     row.Within(4, -2, 2)};
        row.EndsAt(5);
        if (!space.emotions.emplace(emotion, at).second) row.Refuse(emotion + " is here twice");
      } else {
        row.Refuse("'" + key + "' found; units, encode, decode, row or emotion expected");
      }
    }
    if (space.units.empty()) table.Refuse("no row of units");
    CheckLayers(table, "encode", space.encoder, space.units.size(), 3);
    CheckLayers(table, "decode", space.decoder, 3, space.units.size());
    return space;
  });
}

}  // namespace fsm
