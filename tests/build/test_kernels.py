"""What of the user's environment reaches a kernel."""

import pytest

from robo_genesis.build.kernels import clean_environment


@pytest.fixture
def clean(tmp_path, monkeypatch):
    def environment(**variables):
        for name, value in variables.items():
            monkeypatch.setenv(name, value)
        return clean_environment(tmp_path / "home", tmp_path / "run", tmp_path, {"OWN": "1"})

    return environment


@pytest.mark.parametrize("name", ["PYTHONSTARTUP", "MATPLOTLIBRC", "PYTHONHOME", "JUPYTER_PATH"])
def test_a_user_s_set_up_does_not_reach_a_page(clean, name):
    assert name not in clean(**{name: "/mine"})


def test_figures_are_drawn_by_the_notebook_s_backend_whatever_the_user_has(clean):
    assert clean(MPLBACKEND="agg")["MPLBACKEND"] == "module://matplotlib_inline.backend_inline"


@pytest.mark.parametrize("name", ["QD_ARCH", "GS_ENABLE_ZEROCOPY", "PATH", "LC_ALL", "HIP_PATH"])
def test_the_machine_s_own_and_the_engine_s_switches_do(clean, name):
    assert clean(**{name: "x"})[name] == "x"


def test_only_the_checkout_is_importable_and_the_run_s_variables_are_set(clean, tmp_path):
    environment = clean(PYTHONPATH="/mine")
    assert environment["PYTHONPATH"] == str(tmp_path)
    assert (environment["OWN"], environment["PYTHONNOUSERSITE"]) == ("1", "1")
