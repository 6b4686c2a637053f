"""A detector of one's own: peaks above the noise, with their centroids. detector.yaml starts it; docs/howto/plug-in-a-model.md
explains it. It does not know the stars: frames of a camera that follows them need more."""
import dmise
import numpy as np

HALF_PX = 3  # half the window around a peak


@dmise.detector
def find(frame, options):
    counts = frame.counts.astype(float)
    level = np.median(counts)
    noise = 1.4826 * np.median(np.abs(counts - level)) + 0.5
    light_e = (counts - level) * frame.gain_e_per_dn
    noise_e = noise * frame.gain_e_per_dn
    y, x = np.indices((2 * HALF_PX + 1, 2 * HALF_PX + 1)) - HALF_PX
    found = []
    left = light_e.copy()
    while len(found) < options["most"]:
        row, column = np.unravel_index(np.argmax(left), left.shape)
        if left[row, column] < options["threshold"] * noise_e:
            return found
        left[max(row - 2 * HALF_PX, 0):row + 2 * HALF_PX + 1, max(column - 2 * HALF_PX, 0):column + 2 * HALF_PX + 1] = 0
        if not (HALF_PX <= row < light_e.shape[0] - HALF_PX and HALF_PX <= column < light_e.shape[1] - HALF_PX):
            continue
        window = light_e[row - HALF_PX:row + HALF_PX + 1, column - HALF_PX:column + HALF_PX + 1].clip(0)
        flux_e = window.sum()
        sigma_e = np.sqrt(flux_e + window.size * noise_e**2)
        sigma_px = np.sqrt(2 / flux_e + window.size * (2 * noise_e / flux_e)**2)
        found.append(dmise.Found(x_px=column + (x * window).sum() / flux_e, y_px=row + (y * window).sum() / flux_e,
                                 sigma_px=sigma_px, flux_e=flux_e, snr=flux_e / sigma_e))
    return found


if __name__ == "__main__":
    dmise.serve(find)
