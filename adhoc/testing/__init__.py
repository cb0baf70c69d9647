"""Contract tests to inherit: what the library relies on in a world or a policy of your own. Needs pytest."""

import pkgutil

import pytest

# So that a failed assertion of a contract says what was compared, as one in a test file does.
pytest.register_assert_rewrite(*(f"{__name__}.{module.name}" for module in pkgutil.iter_modules(__path__)))
