#pragma once

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>
#include <span>

namespace filmdub {

/// Moves the edge of a chin in a picture: the skin below it is stretched or pressed together, so
/// that nothing is left of the chin where it was. `colours`: three floats a pixel. `before`,
/// `after`: the edge from one side to the other, in its pixels, as many points each; at both ends
/// nothing moves. `along`: to where the person's left is, of length 1. `unit`: the distance between
/// the eyes' outer corners in pixels. Movements of a hundredth of it, which may be the landmarks'
/// trembling, are left out. Returns 255 where something moved, else 0. Pure; thread: any.
cv::Mat MoveChin(cv::Mat& colours, std::span<const glm::vec2> before,
                 std::span<const glm::vec2> after, glm::vec2 along, float unit);

/// So far below the edges something moves, in pixels.
float ChinReach(float unit);

}  // namespace filmdub
