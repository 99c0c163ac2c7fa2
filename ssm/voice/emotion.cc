#include "ssm/voice/emotion.h"

#include <cmath>

namespace ssm {
namespace {

struct Row {
  std::string_view name;
  Manner full;
};

// Directions (not amounts) as found again and again for acted speech: joy, anger and fear faster,
// higher or louder, sadness slower, lower and softer (K. R. Scherer, Speech Communication 40, 2003,
// table 2). The amounts are ours, small enough to stay one speaker.
constexpr Row kTable[] = {{"NEUTRAL", {1, 1, 1}},        {"HAPPY", {1.10, 1.18, 1.15}},
                          {"ANGRY", {1.12, 1.06, 1.45}}, {"DISGUSTED", {0.90, 0.94, 1.00}},
                          {"SAD", {0.80, 0.90, 0.70}},   {"SURPRISED", {1.05, 1.28, 1.20}},
                          {"FEARED", {1.20, 1.20, 0.90}}};

}  // namespace

std::optional<Manner> MannerOf(std::string_view emotion, double strength) {
  for (const Row& row : kTable) {
    if (row.name != emotion) continue;
    const double power = strength / 100;
    return Manner{std::pow(row.full.rate, power), std::pow(row.full.pitch, power),
                  std::pow(row.full.volume, power)};
  }
  return std::nullopt;
}

}  // namespace ssm
