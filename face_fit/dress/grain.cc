#include "face_fit/dress/grain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

namespace facefit {
namespace {

constexpr float kKnown = 0.95F;

glm::ivec2 PlaceOf(const FloatImage& field, std::size_t i) {
  const auto width = static_cast<std::size_t>(field.width);
  return {static_cast<int>(i % width), static_cast<int>(i / width)};
}

}  // namespace

std::vector<std::size_t> NearestKnown(const FloatImage& weight) {
  const std::size_t none = weight.at.size();
  std::vector<std::size_t> nearest(none, none);
  for (std::size_t i = 0; i < none; ++i) {
    if (weight.at[i] >= kKnown) nearest[i] = i;
  }
  // Each takes over what its neighbours know, down and up again (Danielsson, 1980).
  const auto take = [&](int x, int y, int dx, int dy) {
    if (x + dx < 0 || y + dy < 0 || x + dx >= weight.width || y + dy >= weight.height) return;
    std::size_t& mine = nearest[weight.Index(x, y)];
    const std::size_t other = nearest[weight.Index(x + dx, y + dy)];
    if (other == none) return;
    const auto far = [&](std::size_t i) {
      const glm::ivec2 d = PlaceOf(weight, i) - glm::ivec2(x, y);
      return d.x * d.x + d.y * d.y;
    };
    if (mine == none || far(other) < far(mine)) mine = other;
  };
  for (int y = 0; y < weight.height; ++y) {
    for (int x = 0; x < weight.width; ++x) {
      for (const int dx : {-1, 0, 1}) take(x, y, dx, -1);
      take(x, y, -1, 0);
    }
    for (int x = weight.width - 1; x >= 0; --x) take(x, y, 1, 0);
  }
  for (int y = weight.height - 1; y >= 0; --y) {
    for (int x = weight.width - 1; x >= 0; --x) {
      for (const int dx : {-1, 0, 1}) take(x, y, dx, 1);
      take(x, y, 1, 0);
    }
    for (int x = 0; x < weight.width; ++x) take(x, y, -1, 0);
  }
  return nearest;
}

void AddGrain(const FloatImage& weight, const FloatImage& where, int reach, fsm::Image& image) {
  if (std::ranges::max(weight.at) < kKnown) return;
  const auto nearest = NearestKnown(weight);
  const float farthest = 8 * static_cast<float>(reach);
  struct Loan {
    std::size_t to, from;
    float part;
  };
  std::vector<Loan> loans;
  for (std::size_t i = 0; i < weight.at.size(); ++i) {
    if (weight.at[i] >= kKnown || where.at[i] <= 0) continue;
    const glm::ivec2 here = PlaceOf(weight, i), edge = PlaceOf(weight, nearest[i]);
    const glm::ivec2 beyond = 2 * edge - here;
    if (beyond.x < 0 || beyond.y < 0 || beyond.x >= weight.width || beyond.y >= weight.height) {
      continue;
    }
    const std::size_t from = weight.Index(beyond.x, beyond.y);
    const float off = glm::length(glm::vec2(edge - here));
    const float part = where.at[i] * weight.at[from] * (1 - weight.at[i]) *
                       glm::smoothstep(farthest, 0.5F * farthest, off);
    if (part > 0) loans.push_back({i, from, part});
  }
  for (std::size_t c = 0; c < 3; ++c) {
    FloatImage channel(weight.width, weight.height);
    for (std::size_t i = 0; i < channel.at.size(); ++i) {
      channel.at[i] = static_cast<float>(image.rgba[4 * i + c]);
    }
    const FloatImage even = Blurred(channel, reach);
    for (const Loan& loan : loans) {
      const float grain = channel.at[loan.from] - even.at[loan.from];
      image.rgba[4 * loan.to + c] = static_cast<std::uint8_t>(
          glm::clamp(channel.at[loan.to] + loan.part * grain, 0.0F, 255.0F) + 0.5F);
    }
  }
}

}  // namespace facefit
