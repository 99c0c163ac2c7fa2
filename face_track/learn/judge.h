#pragma once

#include <string>
#include <vector>

#include "face_track/learn/sitter.h"

namespace facetrack {

/// How the dose of one unit was found on one face.
struct JudgedDose {
  int unit = 0;
  float found = 0;   ///< of Judge's dose, the mean of both sides
  float others = 0;  ///< the sum of all other units' doses
  float moved = 0;   ///< how far the points went, in parts of what they do as nothing is done
  float gain = 0;    ///< how far they went the way the table has them go, in parts of it
};

/// Prints how turns of a face are found, and how far off its doses are on the mean. Returns them.
/// `shown`: the face shows each unit at 1 first, and doses are found by how it moved.
std::vector<JudgedDose> Judge(const SeenFace& usual, Sitter& sitter, bool shown);

/// A line of each unit over all faces, those of which the points move most first.
std::string TableOfUnits(const std::vector<JudgedDose>& judged);

}  // namespace facetrack
