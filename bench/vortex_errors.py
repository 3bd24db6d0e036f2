"""What a reduced run of vortices misses of a full-order run: positions, and the quantities that positions are for."""

import h5py
import numpy as np

from run_folder import reconstruct

# Fixed places at which the velocity that all vortices induce is compared, in m: between, beside, above and far off.
POINTS = np.array([[0.0, 0.0], [1.6, 0.3], [-0.4, 1.2], [-2.5, -1.5]])


def full_positions(run):
    """Frames × particles × 2."""
    return np.stack([run.frames(name)[3] for name in ("x", "y")], axis=-1)


def reduced_positions(run, reduction):
    state = reconstruct(reduction, run.coordinates()[1])
    return state.reshape(len(state), -1, 2)


def circulations(reduction):
    """Of all particles, by their ids."""
    with h5py.File(reduction) as file:
        mesh = file["windows/0/sample_mesh/model"]
        return mesh["circulations"][:][np.argsort(mesh["sources"][:])]


def centroids(positions, strengths):
    """Centre of circulation of each of the two vortices, which the particles' first places tell apart: frames × 2 × 2."""
    sides = [positions[0, :, 0] < 0, positions[0, :, 0] >= 0]
    return np.stack([np.average(positions[:, side], axis=1, weights=strengths[side]) for side in sides], axis=1)


def induced_velocities(positions, strengths, core_radius):
    """Rosenhead–Moore, at POINTS: frames × points × 2."""
    frames = []
    for places in positions:
        apart = POINTS[:, None, :] - places[None, :, :]
        share = strengths / (2 * np.pi * (np.sum(apart**2, axis=-1) + core_radius**2))
        frames.append(np.stack([-np.sum(share * apart[..., 1], axis=1), np.sum(share * apart[..., 0], axis=1)], axis=-1))
    return np.array(frames)


def relative(found, expected, scale):
    return 100 * float(np.linalg.norm(found - expected) / np.linalg.norm(scale))


def errors(full, reduced, reduction, core_radius):
    """Relative L2 errors over all frames in %: of positions and of centroids, both relative to how far they have moved, and of
    the velocity induced at POINTS."""
    expected, found = full_positions(full), reduced_positions(reduced, reduction)
    strengths = circulations(reduction)
    result = {"positions": relative(found, expected, expected - expected[0])}
    centres = centroids(expected, strengths)
    result["centroids"] = relative(centroids(found, strengths), centres, centres - centres[0])
    velocities = induced_velocities(expected, strengths, core_radius)
    result["induced_velocity"] = relative(induced_velocities(found, strengths, core_radius), velocities, velocities)
    result["quantities"] = max(result["centroids"], result["induced_velocity"])
    return result


def position_error(full, other):
    """Of another full-order run with the same frames, relative to how far particles have moved, in %."""
    expected = full_positions(full)
    return relative(full_positions(other), expected, expected - expected[0])


def spacings_moved(run):
    """How many times their spacing the particles move: the middle one and the one that moves farthest along its path."""
    positions = full_positions(run)
    spacing = run.frames("x")[2]
    nearest = np.sort(np.linalg.norm(spacing[1:200, None, :2] - spacing[None, :400, :2], axis=-1), axis=1)[:, 1].min()
    paths = np.sum(np.linalg.norm(np.diff(positions, axis=0), axis=-1), axis=0)
    return float(np.median(paths) / nearest), float(paths.max() / nearest)
