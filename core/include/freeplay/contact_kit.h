// The contact kit: what the built-in joints with play are made of, for authors who use Eigen (Freeplay::sdk_eigen).
//
// A joint says where its contacts stand, as a class template parameter of play::PlanarContacts; phases, approach speeds
// and their prediction, events, durations and steps of impacts, memory of friction, forces with derivatives, losses and
// channels are the same code for every joint. play::wall_laws reads the block `clearance`; play::law_rows are its keys.
#pragma once

#include "freeplay/kit/planar_contacts.h"
#include "freeplay/kit/planar_slide.h"
#include "freeplay/kit/wall_play.h"
