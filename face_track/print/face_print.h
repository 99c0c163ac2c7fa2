#pragma once

#include <string>
#include <vector>

#include "face_track/follow/face_line.h"

namespace facetrack {

/// Lines of a track as text.
class FacePrint {
 public:
  enum class Format {
    kCsv,        ///< a line of names, then one a picture
    kJsonLines,  ///< an object a picture
    kArkit       ///< CSV of ARKit's 52 blend shapes, then the head's three angles
  };
  struct Extras {
    bool points = false;  ///< the landmarks, not in kArkit
    bool mouth = false;   ///< seal, tongue and m1 to m17, as vdm's tracks have them; not in kArkit
  };
  FacePrint(Format format, Extras extras, const SeenFace& face);
  std::string Header() const;  ///< "" where there is none
  std::string Line(const FaceLine& line) const;

 private:
  struct Column {
    std::string name;
    float value;
  };
  std::vector<Column> Columns(const FaceLine& line) const;
  struct Shape {
    std::string name;
    std::vector<std::pair<std::size_t, float>> parts;
  };
  Format format_;
  Extras extras_;
  const SeenFace& face_;
  std::vector<Shape> shapes_;
};

}  // namespace facetrack
