#include "fsm/app/face_of_name.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "fsm/head/face_folder.h"
#include "fsm/head/face_set.h"
#include "fsm/render/renderer.h"

namespace fsm {

std::unique_ptr<Head> MakeHeadOfName(const std::string& face) {
  if (std::ranges::find(Head::Identities(), face, &IdentityInfo::name) !=
      Head::Identities().end()) {
    return Head::Make(face);
  }
  const std::string folder = FacesFolder() + "/" + face;
  std::ifstream file(folder + "/face.txt");
  const std::string text((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  if (!file) throw std::runtime_error("cannot read " + folder + "/face.txt");
  FaceSet set = ReadFaceSet(folder + "/face.txt", text);
  auto image = ReadImage(folder + "/photo.png");
  if (!image) throw std::runtime_error(image.error().text);
  set.photo =
      std::make_shared<WornPhoto>(WornPhoto{image->width, image->height, std::move(image->rgba)});
  return Head::Make(set);
}

}  // namespace fsm
