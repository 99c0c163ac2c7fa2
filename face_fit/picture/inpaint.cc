#include "face_fit/picture/inpaint.h"

#include <algorithm>
#include <glm/vec4.hpp>
#include <utility>

#include "face_fit/picture/pixels.h"

namespace facefit {

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
    levels[0].at.push_back(glm::vec4(Rgb(image, i), 1) * weight.at[i]);
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
    SetRgb(image, i, glm::vec3(c) / std::max(c.w, 1e-3F));
  }
}

}  // namespace facefit
