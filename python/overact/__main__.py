"""``python -m overact``."""

import sys

from ._command import main

sys.exit(main())
