#pragma once

#include "face_fit/dress/field.h"

namespace facefit {

/// For each point the index of one near it whose weight is nearly 1, its own included; nearest but
/// for rare ties. REQUIRES: there is one.
std::vector<std::size_t> NearestKnown(const FloatImage& weight);

/// What was filled in is smooth: gives it the grain of what lies as far on the other side of the
/// edge, of pores, hair or beard. `weight`: as it was filled; `where`: how much of it, 0..1;
/// `reach`: pixels up to which something counts as grain, and eight times of that it is carried.
void AddGrain(const FloatImage& weight, const FloatImage& where, int reach, fsm::Image& image);

}  // namespace facefit
