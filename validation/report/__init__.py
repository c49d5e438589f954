"""Reports of studies: text, JSON, CSV, pictures, and the command that prints them.

To add a study, write one file in `validation.studies`, its test, a line in ``STUDIES`` of
`validation.cli`, and its command in the list of ``book/reference.md``::

    from validation.report.study import Report, option, study
    from validation.report.table import Column, Table


    @study(
        option("--k", "Exponent.", default=1.5),
        page="reference",
        examples=["lwa-validate cubes --k 2"],
    )
    def cubes(k: float) -> Report:
        '''First line: what the study computes. The first paragraph is the help.'''
        rows = [{"n": n, "power_value": n**k} for n in (1, 2, 3)]
        columns = (Column("n", "n"), Column("power_value", "n^k"))
        return Report(f"powers, k = {k:g}", (Table(columns, rows, "rows"),))

A number with an error is an `lwa.Estimate` in a column `Estimates`; what must hold is a
`Finding`; a picture is a `Panel` of curves. Text, JSON, CSV, ``--plot``, the progress and the exit
status follow. The same file in ``book/studies`` ends with ``cubes.main()`` and is a program.
"""
