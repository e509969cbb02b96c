// ChannelCheck: columns that a model file names and that its mechanism must have.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "format/document.h"
#include "model/channel.h"
#include "model/model.h"

namespace freeplay {

/// The channel that was probably meant, of another kind of column where the first word is none; empty without.
std::string nearest_channel(const std::string& name, const Channels& channels);

/// Reports patterns and names of columns in `simulation` and `study` that fit none, and limits of another dimension
/// than their column. Columns are known only when the whole mechanism is, so this comes last; names that begin with one
/// of `unsure` (of elements that could not be read) are not judged. `by_option`: the patterns of the model are those of
/// --channels, and the first that fits none is thrown as Error{usage} "unknown-channel". A point of a study may lack
/// what `study` names: then `with_study` is false.
void check_channels(const Model& model, const Document& document, const std::vector<std::string>& unsure,
                    bool by_option, bool with_study, Diagnostics& diagnostics);

}  // namespace freeplay
