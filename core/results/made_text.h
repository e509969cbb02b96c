// MadeText: where the record of provenance stands in files of text.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/json_text.h"

namespace freeplay {

/// A text that holds its own record.
struct MadeText {
  Json record = nullptr;  ///< null where it holds none
  std::string data;       ///< the rest of it
};

/// JSON output: the field `provenance`, which is the last.
MadeText split_json(const std::string& text);

/// An SVG picture: JSON in `<metadata>`.
MadeText split_picture(const std::string& text);

/// Is a file that is there an SVG picture with a record?
bool is_own_picture(const std::filesystem::path& file);

/// Puts a record into an SVG picture, at its beginning.
std::string picture_with_record(const std::string& picture, const Json& record);

/// A page: the field `provenance` of the JSON in the script `freeplay-data`. Its data is the text of the field `runs`.
MadeText split_page(const std::string& text);

/// The text of one field of a JSON object as it stands there; empty where it has none.
std::string_view field_text(std::string_view object, std::string_view name);

}  // namespace freeplay
