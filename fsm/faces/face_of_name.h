#pragma once

#include <memory>
#include <optional>
#include <string>

#include "fsm/head/features.h"
#include "fsm/rig/head.h"
#include "fsm/rig/unit_table.h"

namespace fsm {

/// How far each unit moves which skin, in place of fsm/head/tables/action_units.txt: the file of
/// that name in a folder of tables or of a face; nothing if there is none. Throws
/// std::runtime_error naming file and line.
std::optional<UnitTable> UnitsIn(const std::string& folder);
inline constexpr const char* kUnitsFile = "action_units.txt";
inline constexpr const char* kAppearanceFile = "appearance.txt";
inline constexpr const char* kFeaturesFile = "features.txt";
/// What teeth, ears, lashes and the like are like, in place of fsm/head/tables/features.txt: the
/// file of that name in a folder of tables; null if there is none. Throws as UnitsIn.
std::shared_ptr<const Features> FeaturesIn(const std::string& folder);
/// The same head, moved by other units if there are any.
std::unique_ptr<Head> WithUnits(const std::optional<UnitTable>& units, std::unique_ptr<Head> head);
/// The same head, moved by the units of a folder of tables if that has any. Throws as UnitsIn.
std::unique_ptr<Head> WithUnitsOf(const std::string& tables, std::unique_ptr<Head> head);

/// Which folder's units move the face kept in `folder`: its own if it has any, else `tables`.
std::string UnitsFolder(const std::string& folder, const std::string& tables);

/// A built-in head, or one out of the folder of faces (FacesFolder). Its units are those of its own
/// folder, else those of the folder `tables`, else the built-in ones; its features those of
/// `tables`, else the built-in ones. Throws std::runtime_error with a
/// sentence.
std::unique_ptr<Head> MakeHeadOfName(const std::string& face, const std::string& tables = "");

}  // namespace fsm
