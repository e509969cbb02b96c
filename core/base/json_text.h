// JsonText: JSON as files and stdout carry it.
#pragma once

#include <cmath>
#include <string>
#include <utility>

#include <nlohmann/json.hpp>

namespace freeplay {

using Json = nlohmann::ordered_json;

/// A number, or null where there is none.
inline Json json_number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

/// Adds an entry whose name an object does not have yet; operator[] would look through all that it has.
inline Json& append(Json& object, std::string name, Json value) {
  return object.get_ref<Json::object_t&>().emplace_back(std::move(name), std::move(value)).second;
}

/// Indented, ended by a line feed. Bytes that are not UTF-8, as a file name may hold, are replaced.
inline std::string json_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace freeplay
