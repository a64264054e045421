"""Typical mistakes in the functions that a student writes in the lab."""

# By function, what is replaced in our solution, and what replaces it
MISTAKES = {
    "accept": {
        "axis=1": [""],
        "error[:, 3:]": ["error[:, 3:5]", "error[:, :3]"],
        "error[:, :3]": ["error[:, 2:3]"],
        "np.isfinite(q)": ["np.isfinite(q[:, [0, 8]])", "~np.isnan(q)"],
        "<= position_tolerance": ["<= 5e-4", "< position_tolerance"],
        "return np.isfinite(q).all(axis=1) & small": [
            "return np.flatnonzero(small)",
            "return small",
            "return (np.isfinite(q).all(axis=1) & small).all()",
        ],
    },
    "command": {
        'not in "iu"': ['in "f"'],
        "len(set(envs)) != len(envs) or": [""],
        "not set(envs) <= known": ["max(envs) >= len(known)"],
        "range(robot.scene.n_envs)": ["range(9)", "range(4)"],
        "np.shape(q) != (len(envs), len(dofs))": [
            "np.size(q) != len(envs) * len(dofs)",
            "np.shape(q)[:1] != (len(envs),)",
            "np.shape(np.atleast_2d(q)) != (len(envs), len(dofs))",
        ],
        "if envs:": ["if True:"],
        "(q, dofs, envs_idx=envs)": [
            "(q, dofs)",
            "(q, dofs, envs_idx=sorted(envs))",
            "(np.eye(len(known))[:, envs] @ q, dofs)",
            "(q.astype(int), dofs, envs_idx=envs)",
            "(q, dofs, envs_idx=np.isin(range(len(known)), envs))",
        ],
        "raise ValueError": ["raise KeyError"],
    },
    "step_time": {
        "range(warm_up)": ["range(0)"],
        "    finish()\n    times": ["    times"],
        "        finish()\n": [""],
        "np.median(times)": [
            "np.mean(times)",
            "np.min(times)",
            "np.mean(sorted(times)[1:-1] or times)",
            "sorted(times)[len(times) // 2]",
        ],
        "/ steps": [""],
    },
}
