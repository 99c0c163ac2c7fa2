#include "fsm/faces/face_of_name.h"

#include <filesystem>
#include <utility>

#include "fsm/faces/face_folder.h"
#include "fsm/faces/table_names.h"
#include "fsm/head/identity.h"
#include "fsm/head/make_head.h"
#include "fsm/head/photo_head.h"
#include "fsm/image/image_file.h"
#include "vm_protocol/core/or_throw.h"
#include "vm_protocol/core/text_file.h"

namespace fsm {
namespace {

// Thirty times the size of a face from a large photo.
constexpr std::size_t kMaxFileBytes = 16u << 20;

std::string ReadText(const std::string& path) {
  return vm::OrThrow(vm::ReadTextFile(path, kMaxFileBytes));
}

}  // namespace

std::optional<UnitTable> UnitsIn(const TableFolder& folder) {
  const auto own = vm::OrThrow(folder.Find(kUnitsTable));
  if (!own) return std::nullopt;
  return UnitTable(Table(own->path, own->text));
}

std::shared_ptr<const Features> FeaturesIn(const TableFolder& folder) {
  const auto own = vm::OrThrow(folder.Find(kFeaturesTable));
  return own ? std::make_shared<Features>(own->path, own->text) : Features::BuiltIn();
}

std::unique_ptr<Head> WithUnits(const std::optional<UnitTable>& units, std::unique_ptr<Head> head) {
  return units ? head->WithUnits(*units) : std::move(head);
}

TableFolder UnitsFolder(const std::string& folder, const TableFolder& tables) {
  std::error_code error;
  const bool own = std::filesystem::exists(folder + "/" + std::string(kUnitsTable), error);
  return own ? TableFolder(folder) : tables;
}

std::unique_ptr<Head> MakeHeadOfName(const std::string& face, const TableFolder& tables) {
  const auto make = [features = FeaturesIn(tables)](Identity identity) {
    identity.features = features;
    return MakeHead(std::move(identity));
  };
  if (IsBuiltIn(face)) return WithUnits(UnitsIn(tables), make(BuiltInIdentity(face)));
  const std::string folder = FacesFolder() + "/" + face;
  const auto units = UnitsIn(UnitsFolder(folder, tables));
  const std::string own = folder + "/identity.txt";
  std::error_code error;
  if (std::filesystem::exists(own, error)) {
    return WithUnits(units, make(ReadOwnIdentity(own, ReadText(own))));
  }
  PhotoHead head = ReadPhotoHead(folder + "/face.txt", ReadText(folder + "/face.txt"));
  head.features = FeaturesIn(tables);
  head.atlas = std::make_shared<Image>(vm::OrThrow(ReadImage(folder + "/photo.png")));
  return WithUnits(units, MakeHead(head));
}

}  // namespace fsm
