// Page: one HTML file that shows runs, from its parts and its data.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "base/json_text.h"

namespace freeplay {

inline constexpr std::size_t largest_page = 2'000'000;  ///< bytes

/// JSON as it stands in a page: on one line, where no text of it can end the element.
std::string page_json(const Json& json);

/// Bytes of the page without its data and title, whatever sections it has.
std::size_t page_frame_size();

/// `runs`: the list of runs, which decides about sections; `data`: the text of the data, by page_json(); `pictures`: by
/// picture_element(), one after the other.
std::string page_text(const std::string& title, const Json& runs, std::string_view data, const std::string& pictures);

/// An SVG with its title, as an image that can neither run nor load anything.
std::string picture_element(const std::string& svg);

/// Is a file that is there a page of this program?
bool is_page(const std::filesystem::path& file);

}  // namespace freeplay
