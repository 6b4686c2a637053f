"""A detector where a sensor is wanted."""
import dmise

dmise.serve(dmise.detector(lambda frame, options: []))
