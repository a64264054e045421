"""Typical mistakes in the functions that a student writes in the lab."""

# By function, what is replaced in our solution, and what replaces it
MISTAKES = {
    "chain": {
        "if k < 7:": ["if k < 6:", "if k not in (4, 7):"],
        "return at, turn": [
            "return at, turn * [1, -1, -1, -1]",
            "return at, 2 * turn",
            "return at.round(4), turn",
            "return at, np.eye(3)",
        ],
        "(links)": ["(kinematics.CHAIN)"],
        "rotate(turn, position)": ["rotate(quat, position)"],
    },
    "damped": {
        "J.T @ np.linalg.solve(left, error)": [
            "(J.T @ np.linalg.solve(left, error))[:, None]",
            "np.clip(J.T @ np.linalg.solve(left, error), -0.05, 0.05)",
            "np.linalg.pinv(J) @ error",
        ],
        "damping**2": ["0.01**2", "damping", "(damping if m == 6 else 0.01)**2"],
        "np.eye(m)": ["np.eye(6)"],
    },
    "accept": {
        "np.linalg.norm(error[:3])": [
            "error[:3].max()",
            "0.0",
            "np.linalg.norm(error[:2])",
        ],
        "np.linalg.norm(error[3:])": [
            "np.linalg.norm(error[3:5])",
            "np.nan_to_num(np.linalg.norm(error[3:]))",
        ],
        "apart <= position_tolerance": ["apart <= 5e-4"],
        "angle <= rotation_tolerance": ["angle <= 5e-3", "angle < rotation_tolerance"],
        "clearance >= least_clearance": [
            "clearance >= 0.03",
            "clearance >= 0",
            "abs(clearance) >= least_clearance",
        ],
        "np.isfinite(q)": ["np.isfinite(q[:7])", "np.isfinite(q[[0, -1]])"],
    },
    "project": {
        "(seen / depth @ K.T)[:, :2]": [
            "(seen / depth @ K.T)[:, :2] - 0.5",
            "(seen / depth @ K.T)[0, :2]",
        ],
        "transform[:3, :3]": ["transform[:3, :3].T"],
        "K.T": [
            "np.diag([K[0, 0], K[0, 0], 1]) + [K[:, 2]]",
            "np.c_[K[:, :2], (16, 10, 1)].T",
        ],
        "seen[:, 2:] > 0": [
            "seen[:, 2:] < np.inf",
            "seen[:, 2:] > 0.1",
            "abs(seen[:, 2:] - 10) < 10",
        ],
        "(1, -1, -1)": ["(1, 1, -1)"],
    },
    "back_project": {
        "cols + 0.5": ["cols"],
        "rows + 0.5": ["rows"],
        "/ K[1, 1]": ["/ K[0, 0]"],
        "-y, -depth": ["y, depth"],
        "@ transform[:3, :3].T + transform[:3, 3]": [""],
        "* depth / K[0": ["* depth.mean() / K[0"],
        "np.indices(depth.shape)": ["np.indices((20, 32))"],
    },
}
