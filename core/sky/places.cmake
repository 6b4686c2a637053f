# Where things are: Sun and Moon, the Earth's shadow and bulk, apparent places of stars and objects.
dmise_library(core_places
  SOURCES apparent.cpp occultation.cpp refraction.cpp shadow.cpp sun_moon.cpp
  DEPENDS core_frames core_time PkgConfig::ERFA)
