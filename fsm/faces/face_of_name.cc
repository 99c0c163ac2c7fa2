#include "fsm/faces/face_of_name.h"

#include <filesystem>
#include <utility>

#include "fsm/faces/face_folder.h"
#include "fsm/faces/table_folder.h"
#include "fsm/head/identity.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"
#include "fsm/image/image_file.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

constexpr std::size_t kMaxFileBytes = 16u << 20;  // thirty times a face of a large photo

std::string ReadText(const std::string& path) {
  return vm::OrThrow(vm::ReadTextFile(path, kMaxFileBytes));
}

}  // namespace

std::optional<UnitTable> UnitsIn(const std::string& folder) {
  const auto text = TableIn(folder, kUnitsFile);
  if (!text) return std::nullopt;
  return UnitTable(Table(folder + "/" + kUnitsFile, *text));
}

std::shared_ptr<const Features> FeaturesIn(const std::string& folder) {
  const auto text = TableIn(folder, kFeaturesFile);
  return text ? std::make_shared<Features>(folder + "/" + kFeaturesFile, *text) : nullptr;
}

std::unique_ptr<Head> WithUnits(const std::optional<UnitTable>& units, std::unique_ptr<Head> head) {
  return units ? head->WithUnits(*units) : std::move(head);
}

std::unique_ptr<Head> WithUnitsOf(const std::string& tables, std::unique_ptr<Head> head) {
  return WithUnits(UnitsIn(tables), std::move(head));
}

std::string UnitsFolder(const std::string& folder, const std::string& tables) {
  std::error_code error;
  return std::filesystem::exists(folder + "/" + kUnitsFile, error) ? folder : tables;
}

std::unique_ptr<Head> MakeHeadOfName(const std::string& face, const std::string& tables) {
  const auto make = [features = FeaturesIn(tables)](Identity identity) {
    identity.features = features;
    return MakeHead(std::move(identity));
  };
  if (IsBuiltIn(face)) return WithUnitsOf(tables, make(BuiltInIdentity(face)));
  const std::string folder = FacesFolder() + "/" + face;
  const std::string units = UnitsFolder(folder, tables);
  const std::string own = folder + "/identity.txt";
  std::error_code error;
  if (std::filesystem::exists(own, error)) {
    return WithUnitsOf(units, make(ReadOwnIdentity(own, ReadText(own))));
  }
  PhotoHead head = ReadPhotoHead(folder + "/face.txt", ReadText(folder + "/face.txt"));
  head.features = FeaturesIn(tables);
  head.photo = std::make_shared<Image>(vm::OrThrow(ReadImage(folder + "/photo.png")));
  return WithUnitsOf(units, MakeHead(head));
}

}  // namespace fsm
