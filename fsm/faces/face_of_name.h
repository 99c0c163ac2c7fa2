#pragma once

#include <memory>
#include <optional>
#include <string>

#include "fsm/base/table_folder.h"
#include "fsm/head/features.h"
#include "fsm/rig/head.h"
#include "fsm/rig/unit_table.h"

namespace fsm {

/// How far each unit moves which skin, in place of fsm/head/tables/action_units.txt: what a folder
/// of tables or of a face says; nothing if it does not. Throws std::runtime_error naming file and
/// line.
std::optional<UnitTable> UnitsIn(const TableFolder& folder);
/// What teeth, ears, lashes and the like are like, in place of fsm/head/tables/features.txt: what a
/// folder of tables says; null if it does not. Throws as UnitsIn.
std::shared_ptr<const Features> FeaturesIn(const TableFolder& folder);
/// The same head, moved by other units if there are any.
std::unique_ptr<Head> WithUnits(const std::optional<UnitTable>& units, std::unique_ptr<Head> head);
/// Whose units move the face kept in `folder`: its own if it has any, else those of `tables`.
TableFolder UnitsFolder(const std::string& folder, const TableFolder& tables);

/// A built-in head, or one out of the folder of faces (FacesFolder). Its units are those of its own
/// folder, else those of `tables`; its features are those of `tables`. Throws std::runtime_error
/// with a sentence.
std::unique_ptr<Head> MakeHeadOfName(const std::string& face, const TableFolder& tables = {});

}  // namespace fsm
