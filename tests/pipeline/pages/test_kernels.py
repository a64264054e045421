"""The variables of the user's environment that reach a kernel."""

import pytest

from robo_genesis.pipeline.pages.kernels import clean_environment


@pytest.mark.parametrize(
    ("name", "value"),
    [
        *(
            (n, None)
            for n in ("PYTHONSTARTUP", "MATPLOTLIBRC", "PYTHONHOME", "JUPYTER_PATH")
        ),
        *(
            (n, None)
            for n in ("LD_PRELOAD", "OMP_NUM_THREADS", "MKL_CBWR", "GALLIUM_DRIVER")
        ),
        *(
            (n, None)
            for n in ("TORCH_LOGS", "NPY_DISABLE_CPU_FEATURES", "XDG_CACHE_HOME")
        ),
        *(
            (n, "x")
            for n in ("QD_ARCH", "GS_ENABLE_ZEROCOPY", "PATH", "HIP_PATH", "MESA_DEBUG")
        ),
        *((n, "x") for n in ("LD_LIBRARY_PATH", "NVIDIA_TF32_OVERRIDE")),
        *(
            ("LC_ALL", "C.UTF-8"),
            ("TZ", "UTC"),
            ("PYTHONHASHSEED", "0"),
            ("QD_ENABLE_PYBUF", "0"),
        ),
        ("MPLBACKEND", "module://matplotlib_inline.backend_inline"),
        ("PYTHONPATH", "/checkout"),
        ("PYTHONNOUSERSITE", "1"),
        ("OWN", "1"),
    ],
)
def test_variables_of_machine_engine_and_page_reach_a_kernel(
    tmp_path, monkeypatch, name, value
):
    monkeypatch.setenv(name, "x")
    environment = clean_environment(tmp_path, "/checkout", {"OWN": "1"})
    assert environment.get(name) == value
