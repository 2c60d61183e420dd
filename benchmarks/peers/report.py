"""The tables of a run, as Markdown."""


def operations(count):
    """`375 + 9 sc`: operations, pairs of sine and cosine, square roots."""
    extra = [f"{count.trigonometric_pairs} sc"] if count.trigonometric_pairs else []
    extra += [f"{count.square_roots} √"] if count.square_roots else []
    return f"{count.operations}" + (f" + {', '.join(extra)}" if extra else "")


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def counts(results):
    """Operations of every task, for each tool in its best form."""
    tools = list(dict.fromkeys(model.peer for result in results for model in result.models))
    rows = []
    for result in results:
        cells = [result.work.title, f"**{operations(result.function.count)}**"]
        for tool in tools:
            own = [m.count for m in result.models if m.peer == tool]
            cells.append(operations(min(own, key=lambda c: c.operations)) if own else "–")
        rows.append([*cells, result.work.quoted or "–"])
    return table(["work", "overact", *tools, "quoted"], rows)


def times(results):
    """Nanoseconds per call, and the ratio to the fastest peer."""
    tools = list(dict.fromkeys(model.peer for result in results for model in result.models if model.code))
    rows = []
    for result in results:
        if result.times is None:
            continue
        own, peers = result.times
        cells = [result.work.title, f"**{own:.0f}**"]
        for tool in tools:
            of = [t for m, t in peers if m.peer == tool]
            cells.append(f"{min(of):.0f}" if of else "–")
        rows.append([*cells, f"{own / min(t for _, t in peers):.2f}"])
    return table(["work, ns per call", "overact", *tools, "overact / fastest peer"], rows)


def blocks(work, times):
    """Nanoseconds per sample of a compiled function and of blocks, and their ratio."""
    names = ["compiled function", "blocks as they lie", "blocks to rows"]
    lines = [[n, f"{t:.0f}", f"{t / times[0]:.2f}"] for n, t in zip(names, times, strict=True)]
    return table([f"{work.title}, ns per sample", "time", "ratio"], lines)


def calls(times):
    """Nanoseconds of Pinocchio's regressors, called from Python."""
    lines = [[name, f"{regressor:.0f}", f"{nothing:.0f}"] for name, regressor, nothing in times]
    return table(["10 columns a joint, ns", "Pinocchio, from Python", "of which a call"], lines)
