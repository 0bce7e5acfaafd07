#include "pendulum/recording/resolution.h"
