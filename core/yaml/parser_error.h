// What the parser library says against a text, in words for the author of a model and at the place of the mistake.
#pragma once

#include "base/diagnostics.h"
#include "base/text_place.h"
#include "format/document.h"

namespace YAML {
class Exception;
}

namespace freeplay {

/// `innermost` is where the collection begins that was being read.
void report_parser_error(const YAML::Exception& error, const Document& document, const TextPlace& innermost,
                         Diagnostics& diagnostics);

}  // namespace freeplay
