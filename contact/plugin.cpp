// The contact and friction laws of the library, one row each.
#include "freeplay/plugin.h"

namespace freeplay {
Component hertz();
Component kelvin_voigt();
Component hunt_crossley();
Component herbert_mcwhannell();
Component lee_wang();
Component lankarani_nikravesh();
Component gonthier();
Component flores();
Component hu_guo();
Component zhiying_qishao();
Component johnson();
Component radzimovsky();
Component esdu_78035();
Component no_friction();
Component coulomb_tanh();
Component coulomb_linear();
Component coulomb_atan();
Component ambrosio();
Component threlfall();
Component bengisu_akay();
Component stribeck();
Component lugre();
Component expression_contact();
Component expression_friction();
}  // namespace freeplay

FREEPLAY_PLUGIN(contact) {
  using namespace freeplay;
  static const Component components[] = {hertz(),
                                         kelvin_voigt(),
                                         hunt_crossley(),
                                         herbert_mcwhannell(),
                                         lee_wang(),
                                         lankarani_nikravesh(),
                                         gonthier(),
                                         flores(),
                                         hu_guo(),
                                         zhiying_qishao(),
                                         johnson(),
                                         radzimovsky(),
                                         esdu_78035(),
                                         no_friction(),
                                         coulomb_tanh(),
                                         coulomb_linear(),
                                         coulomb_atan(),
                                         ambrosio(),
                                         threlfall(),
                                         bengisu_akay(),
                                         stribeck(),
                                         lugre(),
                                         expression_contact(),
                                         expression_friction()};
  return publish(*host, *manifest, "contact", "0.1.0", components);
}
