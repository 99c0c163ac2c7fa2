#pragma once

#include <map>
#include <string>
#include <vector>

#include "face_space/eigen/eigen_units.h"
#include "face_space/table/unit_tables.h"

namespace facespace {

/// What the analyses found, as text for people: variance kept, mm.
std::string EigenReport(const StillFaces& faces, const EigenUnits& units);
/// Where the tables are and how near fsm comes to the shapes.
std::string TableReport(const Placement& placement, const FaceAtRest& rest,
                        const UnitTables& tables, const std::string& folder);
/// CSV: a line for each face vector and recorded unit: name, share of the variance, mm at the
/// markers.
std::string VectorsCsv(const FaceAtRest& rest, const EigenUnits& units,
                       const std::vector<RecordedUnit>& recorded);

/// The face vectors as units: each in its positive and, where the recordings go there by more than
/// a tenth of that, its negative direction, since units have no negative strengths. Strength 1 is
/// as far as the recordings go.
std::vector<ShapeUnit> EigenShapes(const EigenUnits& units);
/// The motion vectors as lines for fsm, a file each: `set AU` and `set Wait`, at the size the
/// recordings have; none of those whose units were not written.
std::map<std::string, std::string> MotionLines(const StillFaces& faces, const EigenUnits& units,
                                               const std::vector<WrittenUnit>& written);

}  // namespace facespace
