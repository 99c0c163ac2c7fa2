#include "face_fit/dress/field.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec4.hpp>

namespace facefit {

float FloatImage::Between(float x, float y) const {
  const float px = std::clamp(x - 0.5F, 0.0F, static_cast<float>(width - 1));
  const float py = std::clamp(y - 0.5F, 0.0F, static_cast<float>(height - 1));
  const int x0 = static_cast<int>(px), y0 = static_cast<int>(py);
  const int x1 = std::min(x0 + 1, width - 1), y1 = std::min(y0 + 1, height - 1);
  const float u = px - static_cast<float>(x0), v = py - static_cast<float>(y0);
  return (at[Index(x0, y0)] * (1 - u) + at[Index(x1, y0)] * u) * (1 - v) +
         (at[Index(x0, y1)] * (1 - u) + at[Index(x1, y1)] * u) * v;
}

FloatImage Blurred(const FloatImage& field, int reach) {
  // Running sums along rows, then along columns; the window shrinks at the edges.
  const auto pass = [reach](const float* in, float* out, int n, std::size_t step) {
    double sum = 0;
    int count = 0;
    const auto value = [&](int i) {
      return static_cast<double>(in[static_cast<std::size_t>(i) * step]);
    };
    for (int i = 0; i < std::min(reach, n); ++i, ++count) sum += value(i);
    for (int i = 0; i < n; ++i) {
      if (i + reach < n) sum += value(i + reach), ++count;
      if (i - reach - 1 >= 0) sum -= value(i - reach - 1), --count;
      out[static_cast<std::size_t>(i) * step] = static_cast<float>(sum / count);
    }
  };
  FloatImage rows(field.width, field.height), out(field.width, field.height);
  for (int y = 0; y < field.height; ++y) {
    pass(&field.at[field.Index(0, y)], &rows.at[field.Index(0, y)], field.width, 1);
  }
  for (int x = 0; x < field.width; ++x) {
    pass(&rows.at[field.Index(x, 0)], &out.at[field.Index(x, 0)], field.height,
         static_cast<std::size_t>(field.width));
  }
  return out;
}

void PushPullInpaint(fsm::Image& image, const FloatImage& weight) {
  struct Level {
    int width, height;
    std::vector<glm::vec4> at;  // colour times weight, weight
    glm::vec4& Of(int x, int y) {
      return at[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) *
                    static_cast<std::size_t>(width) +
                static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
    }
  };
  std::vector<Level> levels{{image.width, image.height, {}}};
  for (std::size_t i = 0; i < weight.at.size(); ++i) {
    const std::uint8_t* p = &image.rgba[4 * i];
    levels[0].at.push_back(glm::vec4(p[0], p[1], p[2], 1) * weight.at[i]);
  }
  while (levels.back().width > 1 || levels.back().height > 1) {
    Level& fine = levels.back();
    Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
    for (int y = 0; y < coarse.height; ++y) {
      for (int x = 0; x < coarse.width; ++x) {
        glm::vec4 sum(0);
        for (int k = 0; k < 4; ++k) {
          const int fx = 2 * x + k % 2, fy = 2 * y + k / 2;
          if (fx < fine.width && fy < fine.height) sum += fine.Of(fx, fy);
        }
        coarse.at.push_back(sum.w > 1 ? sum / sum.w : sum);
      }
    }
    levels.push_back(std::move(coarse));
  }
  for (std::size_t l = levels.size() - 1; l-- > 0;) {
    Level& fine = levels[l];
    Level& coarse = levels[l + 1];
    for (int y = 0; y < fine.height; ++y) {
      for (int x = 0; x < fine.width; ++x) {
        glm::vec4& here = fine.Of(x, y);
        if (here.w >= 1) continue;
        const int nx = x % 2 ? x / 2 + 1 : x / 2 - 1, ny = y % 2 ? y / 2 + 1 : y / 2 - 1;
        glm::vec4 from = 0.5625F * coarse.Of(x / 2, y / 2) + 0.1875F * coarse.Of(nx, y / 2) +
                         0.1875F * coarse.Of(x / 2, ny) + 0.0625F * coarse.Of(nx, ny);
        if (from.w > 0) from /= from.w;
        here += from * (1 - here.w);
      }
    }
  }
  for (std::size_t i = 0; i < weight.at.size(); ++i) {
    const glm::vec4 c = levels[0].at[i];
    for (std::size_t k = 0; k < 3; ++k) {
      image.rgba[4 * i + k] = static_cast<std::uint8_t>(
          std::clamp(c[static_cast<int>(k)] / std::max(c.w, 1e-3F) + 0.5F, 0.0F, 255.0F));
    }
  }
}

}  // namespace facefit
