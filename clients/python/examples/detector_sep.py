"""A detector by SEP, the library of SExtractor (pip install sep): round sources among the trails of stars. detector_sep.yaml starts it."""
import dmise
import numpy as np
import sep


@dmise.detector
def find(frame, options):
    light_e = frame.counts.astype(np.float32) * frame.gain_e_per_dn
    background = sep.Background(light_e)
    light_e -= background
    noise_e = background.globalrms
    found = sep.extract(light_e, options["threshold"], err=noise_e, gain=1.0)
    found = found[found["a"] < options["longest"] * found["b"]]  # the camera follows the object, so stars are trails
    flux_e, sigma_e, _ = sep.sum_circle(light_e, found["x"], found["y"], 2 * frame.header["PSFFWHM"], err=noise_e, gain=1.0)
    return dmise.Found(x_px=found["x"], y_px=found["y"], covariance_px2=[found["errx2"], found["errxy"], found["erry2"]],
                       flux_e=flux_e, snr=flux_e / sigma_e)


dmise.serve(find)
