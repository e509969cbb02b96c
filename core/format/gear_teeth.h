// Teeth of a gear that press at the pitch point, without play.
#pragma once

#include "format/draft.h"

namespace freeplay {

/// Gives `gear` teeth with the pressure angle that `written` says; the joints that it couples are known. Reports where
/// the two joints cannot have teeth between them.
void give_teeth(Draft& draft, const CheckedValue& written, const Gear& gear);

}  // namespace freeplay
