// trichrome-mpi: one of the processes that mpirun (or srun) started.

#include "engine/base/check.h"
#include "ui/cli/interrupt.h"
#include "ui/cli/ranks.h"

#define OMPI_SKIP_MPICXX // the C interface alone
#include <mpi.h>

namespace ui
{

namespace
{

constexpr int RECORD = 1; // message tag

class Mpi : public Ranks
{
  public:
    Mpi()
    {
        MPI_Init(nullptr, nullptr); // on failure MPI says so and ends the processes
        MPI_Comm_rank(MPI_COMM_WORLD, &index_);
        MPI_Comm_size(MPI_COMM_WORLD, &count_);
    }
    uint32_t index() const override { return uint32_t(index_); }
    uint32_t count() const override { return uint32_t(count_); }
    void barrier() const override { MPI_Barrier(MPI_COMM_WORLD); }

    std::vector<Bytes> gather(const std::vector<Bytes>& records) const override
    {
        const int own = int(records.size());
        std::vector<int> counts(size_t(count_), 0);
        MPI_Gather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
        if (index_ != 0) {
            for (const Bytes& record : records)
                MPI_Send(record.data(), int(record.size()), MPI_BYTE, 0, RECORD, MPI_COMM_WORLD);
            return {};
        }
        std::vector<Bytes> all = records;
        for (int rank = 1; rank < count_; ++rank)
            for (int i = 0; i < counts[size_t(rank)]; ++i) {
                MPI_Status status;
                int size = 0;
                MPI_Probe(rank, RECORD, MPI_COMM_WORLD, &status);
                MPI_Get_count(&status, MPI_BYTE, &size);
                all.emplace_back(size_t(size));
                MPI_Recv(all.back().data(), size, MPI_BYTE, rank, RECORD, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
            }
        return all;
    }

    int finish(int exitCode) const override
    {
        if (exitCode != 0 && exitCode != Interrupt::exitCode())
            MPI_Abort(MPI_COMM_WORLD, exitCode); // else the others wait
        MPI_Finalize();
        return exitCode;
    }

  private:
    int index_ = 0, count_ = 1;
};

} // namespace

const Ranks& ranks()
{
    static const Mpi MPI;
    return MPI;
}

} // namespace ui
